#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/error.h"
#include "debian_python.h"
#include "record/contact_fields.h"
#include "record/run_fields.h"
#include "record/stage_fields.h"
#include "results/record_json.h"
#include "results/result_writer.h"
#include "results/run_data.h"
#include "sample_run.h"

// What tables of fields describe is in the files, under these names, and pages and types that people write know all of it.

namespace keyblock::results {
namespace {

using nlohmann::ordered_json;

std::string source(const char* path) {
  return read_file(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / path);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string last_part(const std::string& name) {
  return name.substr(name.find('.') + 1);
}

TEST(DescribedOnce, FieldsOfStagesAreInTheGuideAndInTheTypesOfThePage) {
  const std::string guide = source("docs/guide/results.md"), types = source("viewer/src/data.ts");
  const record::StageRecord stage;
  record::visit_stage(stage, [&](const record::StageField& field, const auto&) {
    EXPECT_STRNE(field.meaning, "") << field.name;
    if (field.file == record::RecordFile::summary) {
      const std::string name = std::string("stages[].") + field.name;
      const bool is_told = has(guide, "`" + name) || has(guide, "`." + last_part(field.name) + "`");
      EXPECT_TRUE(is_told) << "docs/guide/results.md has no " << name;
    }
    const bool is_typed = has(types, " " + last_part(field.name) + ": ");
    EXPECT_TRUE(is_typed || field.file == record::RecordFile::result)
        << "viewer/src/data.ts has no " << field.name;
  });
}

std::string table_of_stages() {
  std::string table = "| field | unit | what | also in |\n|---|---|---|---|\n";
  const record::StageRecord stage;
  record::visit_stage(stage, [&](const record::StageField& field, const auto&) {
    std::string row = "| `" + std::string(field.name) + "`";
    const char* also = field.file == record::RecordFile::summary ? "summary.json, report"
                       : field.file == record::RecordFile::page  ? "report"
                                                                 : "";
    for (const char* cell : {field.unit, field.meaning, also}) row += std::string(" | ") + cell;
    table += row + " |\n";
  });
  return table;
}

// With KEYBLOCK_UPDATE_EXPECTED set, the table of the page is written instead of compared.
TEST(DescribedOnce, ThePageOfTheResultFileHasTheFieldsOfStages) {
  const std::string begin = "<!-- written by tests/unit/results/described_once_test.cpp -->\n",
                    end = "<!-- the end of it -->";
  const std::string page = source("docs/result-file.md");
  const std::size_t from = page.find(begin) + begin.size(), to = page.find(end);
  ASSERT_LT(from, to);
  const std::string expected = page.substr(0, from) + table_of_stages() + page.substr(to);
  if (std::getenv("KEYBLOCK_UPDATE_EXPECTED") != nullptr) {
    write_file_atomically(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "docs/result-file.md", expected);
    return;
  }
  EXPECT_EQ(page, expected) << "run this test with KEYBLOCK_UPDATE_EXPECTED=1 set and commit the page";
}

TEST(DescribedOnce, FieldsOfRunsAreInTheGuideAndReadByEarlierNames) {
  const std::string guide = source("docs/guide/results.md");
  SampleRun sample;
  const record::RunRecord run = sample.run();
  ordered_json written = ordered_json::parse(run_json(run));
  record::visit_run(run, [&](const record::RunField& field, const auto&) {
    const bool is_told = has(guide, "`" + std::string(field.name));
    EXPECT_TRUE(is_told || field.file != record::RecordFile::summary)
        << "docs/guide/results.md has no " << field.name;
    if (field.earlier == nullptr) return;
    written[field.earlier] = written.at(field.name);
    written.erase(field.name);
  });
  EXPECT_FALSE(written.contains("wall_time_s"));
  EXPECT_EQ(run_json(read_run_json(written.dump())), run_json(run));
}

// All bytes of a record are in the table but for what lies between members of different sizes, and what the scenario says of a stage.
TEST(DescribedOnce, NoFieldOfStagesIsMissing) {
  const record::StageRecord stage;
  const auto place = [&](const auto& value) {
    return static_cast<std::size_t>(reinterpret_cast<const char*>(&value) -
                                    reinterpret_cast<const char*>(&stage));
  };
  std::map<std::size_t, std::size_t> ends{{place(stage.stage), place(stage.stage) + sizeof(stage.stage)}};
  record::visit_stage(stage, [&](const record::StageField&, const auto& value) {
    if (place(value) >= ends.begin()->second) ends[place(value)] = place(value) + sizeof(value);
  });
  ends[sizeof(stage)] = sizeof(stage);
  std::size_t reached = 0;
  for (const auto& [begin, end] : ends) {
    EXPECT_LT(begin - reached, alignof(double)) << "bytes " << reached << " to " << begin;
    reached = end;
  }
}

TEST(DescribedOnce, NumbersOfContactsAreOnThePageOfTheResultFile) {
  const std::string page = source("docs/result-file.md");
  for (const record::ContactField& field : record::contact_fields) {
    std::size_t count = 0;  // result.h5, contacts.csv, contacts_N.vtp
    for (std::size_t at = page.find("`" + std::string(field.name) + "`"); at != std::string::npos;
         at = page.find("`" + std::string(field.name) + "`", at + 1))
      ++count;
    const bool heads_a_row = has(page, "`contacts/" + std::string(field.name) + "`");
    EXPECT_GE(count + (heads_a_row ? 1 : 0), 3U) << field.name;
  }
}

// Development versions before the table, and version 0.1, had other names.
TEST(DescribedOnce, StagesByTheNamesOfEarlierVersionsAreRead) {
  SampleRun sample;
  const record::StageRecord stage = sample.stage(0);
  ordered_json written = ordered_json::parse(stage_json(0, stage, true));
  int renamed = 0;
  record::visit_stage(stage, [&](const record::StageField& field, const auto&) {
    if (field.earlier == nullptr) return;
    const std::string name = field.name;
    ordered_json& group = has(name, ".") ? written[name.substr(0, name.find('.'))] : written;
    written[field.earlier] = group.at(last_part(name));
    group.erase(last_part(name));
    ++renamed;
  });
  written.erase("equilibrium");
  EXPECT_EQ(renamed, 11);
  const StageLine line = read_stage_json(written.dump());
  EXPECT_EQ(stage_json(0, line.stage, true), stage_json(0, stage, true));
  written.erase("pgv");  // as in version 0.1
  EXPECT_EQ(read_stage_json(written.dump()).stage.pgv, 0.0);
  written.erase("pga");
  EXPECT_THROW(read_stage_json(written.dump()), InputError);
}

TEST(DescribedOnce, ContactsWithTheSizeOfTheirSlipAloneAreRead) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  const RunData before = read_run(folder);
  const PythonResult done = python(
      folder,
      "import sys, h5py\ndel h5py.File(sys.argv[1] + '/result.h5', 'r+')['contacts/shear_displacement']\n",
      folder.string());
  ASSERT_EQ(done.status, 0) << done.output;
  const RunData after = read_run(folder);
  ASSERT_EQ(after.contacts.size(), before.contacts.size());
  for (std::size_t k = 0; k < after.contacts.size(); ++k) {
    for (std::size_t c = 0; c < after.contacts[k].contacts.size(); ++c) {
      EXPECT_EQ(after.contacts[k].contacts[c].shear_displacement, before.contacts[k].contacts[c].slip());
      EXPECT_EQ(after.contacts[k].contacts[c].gap, before.contacts[k].contacts[c].gap);
    }
  }
}

}  // namespace
}  // namespace keyblock::results
