#include "study/outputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/error.h"
#include "study/measures.h"
#include "study/study_json.h"
#include "synthetic_study.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;

class Outputs : public ::testing::Test {
 protected:
  const FreshFolder directory;
};

/// RFC 4180, as a reader does it.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows{{""}};
  bool quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quoted) {
      if (c == '"' && k + 1 < text.size() && text[k + 1] == '"')
        rows.back().back() += text[++k];
      else if (c == '"')
        quoted = false;
      else
        rows.back().back() += c;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      rows.back().emplace_back();
    } else if (c == '\n') {
      rows.emplace_back(1);
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

std::size_t column(const std::vector<std::string>& header, const std::string& name) {
  const auto found = std::find(header.begin(), header.end(), name);
  EXPECT_NE(found, header.end()) << name;
  return static_cast<std::size_t>(found - header.begin());
}

TEST_F(Outputs, RunsCsvHasARowPerRun) {
  StudyData study = made_up::synthetic_study({.realizations = 8});
  study.runs[0].values[1] = "\"stiff, soft\"";
  study.runs[1].error = "line one\nand \"two\"";
  study.runs[0].stages[1].damage.fallen_area = 0.1 + 0.2;
  study.runs[0].stages[1].damage.closure_vertical = std::nan("");
  const auto rows = parse_csv(runs_csv(study, summarize(study)));
  ASSERT_EQ(rows.size(), study.runs.size() + 1);
  const auto& header = rows[0];
  const std::vector<std::string> first{"key",
                                       "realization",
                                       "stage.'first earthquake'.scale",
                                       "rock.order",
                                       "variant",
                                       "status",
                                       "error",
                                       "wall_time_s",
                                       "steps",
                                       "blocks",
                                       "unconverged_steps",
                                       "max_overlap_m",
                                       "energy_residual_ratio",
                                       "marginal",
                                       "excavated.pga_m_s2",
                                       "excavated.pgv_m_s",
                                       "excavated.arias_m_s",
                                       "excavated.fallen_blocks"};
  ASSERT_GE(header.size(), first.size());
  EXPECT_EQ(std::vector<std::string>(header.begin(), header.begin() + static_cast<long>(first.size())),
            first);
  EXPECT_EQ(header.size(), 14U + 3U * (3U + measures().size()));
  for (const auto& row : rows) EXPECT_EQ(row.size(), header.size());
  EXPECT_EQ(rows[1][column(header, "rock.order")], "stiff, soft");
  EXPECT_EQ(rows[2][column(header, "error")], "line one\nand \"two\"");
  EXPECT_EQ(rows[2][column(header, "status")], "failed");
  EXPECT_EQ(rows[1][column(header, "first earthquake.fallen_area_m2")], "0.30000000000000004");
  EXPECT_EQ(rows[1][column(header, "first earthquake.closure_vertical_m")], "");
  const std::size_t failed = column(header, "status");
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r][failed] == "failed" && study.runs[r - 1].stages.empty()) {
      EXPECT_EQ(rows[r][column(header, "after.fallen_area_m2")], "");
    }
  }
}

TEST_F(Outputs, StudyJsonSaysWhatTheStatisticsAre) {
  const StudyData study = made_up::synthetic_study();
  const Summary summary = summarize(study);
  const auto json = nlohmann::json::parse(study_json(study, summary));
  EXPECT_EQ(json["title"], study.title);
  EXPECT_EQ(json["seed"].get<std::uint64_t>(), study.seed);
  EXPECT_EQ(json["runs"]["planned"], study.planned);
  EXPECT_EQ(json["runs"]["done"].get<std::size_t>() + json["runs"]["failed"].get<std::size_t>(),
            study.runs.size());
  EXPECT_EQ(json["axes"][0]["shaking"], true);
  ASSERT_EQ(json["combinations"].size(), 8U);
  const auto& c = json["combinations"][6];
  EXPECT_EQ(c["values"], (nlohmann::json{"1.0", "1"}));
  const auto& fallen = c["measures"]["fallen_area_m2"];
  const auto& expected = summary.combinations[6].measures[*find_measure("fallen_area_m2")].description;
  EXPECT_NEAR(fallen["mean"]["value"].get<double>(), expected.mean.value, 1e-5 * expected.mean.value);
  EXPECT_LT(fallen["mean"]["low"].get<double>(), fallen["mean"]["high"].get<double>());
  EXPECT_EQ(fallen["quantiles"][2]["p"], 0.5);
  EXPECT_EQ(fallen["running_mean"]["low"][0], nullptr);
  EXPECT_EQ(c["levels"][0]["name"], "light");
  EXPECT_EQ(c["map"]["fallen"].size(), 1600U);
  ASSERT_EQ(json["fragility"].size(), 3U * 3U * 2U);
  const auto& curve = json["fragility"][0];
  EXPECT_EQ(curve["values"], (nlohmann::json{nullptr, "1"}));
  EXPECT_EQ(curve["status"], "fitted");
  EXPECT_EQ(curve["why"], nullptr);
  EXPECT_EQ(json["before"], "excavated");
  EXPECT_EQ(json["at_shaking"], true);
  EXPECT_EQ(c["before"]["levels"][0]["exceeded"], summary.combinations[6].before->levels[0].exceeded);
  EXPECT_EQ(c["added"]["measures"]["fallen_area_m2"]["n"], c["n"]);
  EXPECT_EQ(curve["points"]["n"].size(), 4U);
  EXPECT_EQ(curve["curve"]["low"].size(), curve["curve"]["intensity"].size());
  EXPECT_FALSE(json["failed"].empty());
}

// Coordinates of a national grid need more than six digits; what is not known is null.
TEST_F(Outputs, StudyJsonKeepsCoordinatesWholeAndTheRestShort) {
  StudyData study = made_up::synthetic_study({.realizations = 6, .variants = false, .failures = false});
  study.outlines = {{{612345.125, 4812345.75}, {612347.125, 4812345.75}, {612346.0, 4812347.5}}};
  study.grid.corner = {612340.0625, 4812340.5};
  study.levels = {{"any", "fallen_area_m2", -1.0}, {"third", "fallen_area_m2", 1.0 / 3.0}};
  study.precision->reached = true;
  const auto json = nlohmann::json::parse(study_json(study, summarize(study)));
  EXPECT_EQ(json["outlines"][0][0], (nlohmann::json{612345.125, 4812345.75}));
  EXPECT_EQ(json["grid"]["corner"], (nlohmann::json{612340.0625, 4812340.5}));
  EXPECT_EQ(json["levels"][1]["threshold"], 0.333333);
  EXPECT_EQ(json["fragility"][0]["status"], "always_exceeded");
  EXPECT_EQ(json["fragility"][0]["theta"]["value"], nullptr);
  EXPECT_EQ(json["fragility"][0]["points"]["realizations"][0], 6);
  EXPECT_TRUE(json["fragility"][0]["curve"]["intensity"].empty());
  EXPECT_EQ(json["fragility"][0]["why"], "every run exceeds the level");
  EXPECT_EQ(json["precision"]["reached"], true);
}

// Four realizations have a fit, but no interval of it: neither the curve nor its parameters are told.
TEST_F(Outputs, StudyJsonHasNoParametersWithoutACurve) {
  const StudyData study = made_up::synthetic_study({.realizations = 4, .variants = false, .failures = false});
  const Summary summary = summarize(study);
  const auto json = nlohmann::json::parse(study_json(study, summary));
  const auto refused = std::find_if(summary.fragility.begin(), summary.fragility.end(), [](const auto& g) {
    return g.curve.status == statistics::FragilityStatus::too_few_clusters;
  });
  ASSERT_NE(refused, summary.fragility.end());
  EXPECT_FALSE(std::isnan(refused->curve.theta.value));
  const auto& curve = json["fragility"][static_cast<std::size_t>(refused - summary.fragility.begin())];
  EXPECT_EQ(curve["status"], "too_few_realizations");
  EXPECT_EQ(curve["theta"]["value"], nullptr);
  EXPECT_EQ(curve["beta"]["value"], nullptr);
  EXPECT_EQ(curve["points"]["probability"].size(), 4U);
}

TEST_F(Outputs, SameStudySameBytes) {
  const StudyData study = made_up::synthetic_study({.realizations = 12});
  write_outputs(directory, study);
  const std::string json = read_file(directory / "study.json"), page = read_file(directory / "report.html");
  write_outputs(directory, study);
  EXPECT_EQ(read_file(directory / "study.json"), json);
  EXPECT_EQ(read_file(directory / "report.html"), page);
  EXPECT_NE(page.find("<title>Tunnel &lt;synthetic&gt; &amp; shaken</title>"), std::string::npos);
  EXPECT_TRUE(fs::exists(directory / "runs.csv"));
}

TEST_F(Outputs, AnEmptyStudyIsWritten) {
  write_outputs(directory, {});
  const auto json = nlohmann::json::parse(read_file(directory / "study.json"));
  EXPECT_TRUE(json["combinations"].empty());
}

TEST_F(Outputs, AFolderThatCannotBeWrittenIsARunError) {
  EXPECT_THROW(write_outputs(directory / "missing", made_up::synthetic_study({.realizations = 2})), RunError);
}

// 10,000 runs × 100 combinations. How long that takes depends on the machine, and is no test.
TEST_F(Outputs, TenThousandRunsMakeFilesThatOpen) {
  made_up::SyntheticStudyOptions options{.realizations = 100, .variants = false, .failures = false};
  options.scales.clear();
  for (int k = 1; k <= 50; ++k) options.scales.push_back(std::to_string(0.02 * k));
  const StudyData study = made_up::synthetic_study(options);
  ASSERT_EQ(study.runs.size(), 10'000U);
  write_outputs(directory, study);
  const auto megabytes = [&](const char* name) {
    return 1e-6 * static_cast<double>(fs::file_size(directory / name));
  };
  EXPECT_LT(megabytes("study.json"), 20.0);
  EXPECT_LT(megabytes("report.html"), 8.0);
}

}  // namespace
}  // namespace keyblock::study
