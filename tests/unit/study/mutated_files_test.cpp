#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "../fresh_folder.h"
#include "../mutations.h"
#include "core/error.h"
#include "core/read_file.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/plan_checks.h"
#include "study/plan_json.h"
#include "study/run_json.h"
#include "study/study_json.h"
#include "study/study_page.h"

namespace keyblock::study {
namespace {

TEST(RunKeys, AreKnownFromPaths) {
  for (const char* key : {"r0001-0123456789", "r12345-abcdefabcd"}) EXPECT_TRUE(is_run_key(key)) << key;
  for (const char* key : {"", ".", "..", "-", "r", "../victim", "/tmp/victim", "r0001-0123456789/..",
                          "r0001-012345678", "r0001-01234567890", "r001-0123456789", "R0001-0123456789",
                          "r0001-012345678G", "r00 1-0123456789", "r0001-0123456789\n", "r-0001-0123456789"})
    EXPECT_FALSE(is_run_key(key)) << key;
}

/// A study of which all runs are done.
class MutatedStudy : public ::testing::Test {
 protected:
  MutatedStudy() {
    const std::filesystem::path file = std::filesystem::path(KEYBLOCK_TEST_DATA) / "study/gallery.toml";
    Plan plan = make_plan(file, {}, "1.2.3");
    enter_plan(folder_, plan, false);
    for (const PlannedRun& run : plan.runs) {
      RunResult result = empty_result(run);
      result.state_hash = "00ff";
      StageMeasures stage{plan.stage, record::StageKind::shake, 1.1, 0.2, 0.3, {}};
      stage.damage.fallen_blocks = 1;
      result.stages = {{plan.since, record::StageKind::settle, 0.0, 0.0, 0.0, {}}, stage};
      result.fallen = {{3, "slab", 1, {0.1, -0.2}, 0.7, 0.1, 0.9, record::WallPart::right}};
      result.map.assign(
          static_cast<std::size_t>(plan.grid.columns) * static_cast<std::size_t>(plan.grid.rows),
          record::BlockStatus::fallen);
      make_run_folder(folder_, run.key);
      write(run_folder(folder_, run.key) / "run.json", run_json(result, run_input(plan)));
    }
    run_ = run_folder(folder_, plan.runs.at(1).key) / "run.json";
  }

  static void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }

  /// All that is made of a study. True when it could be read.
  [[nodiscard]] bool used() const {
    try {
      const Plan plan = read_plan(folder_);
      const StudyData study = study_data(plan, read_study_files(folder_, plan));
      const Summary summary = summarize(study);
      const std::string json = study_json(study, summary);
      static_cast<void>(runs_csv(study, summary));
      static_cast<void>(study_page(folder_, study, summary, json));
    } catch (const InputError& error) {
      return false;
    }
    return true;
  }

  const FreshFolder folder_;
  std::filesystem::path run_;
};

TEST_F(MutatedStudy, ResultsOfARun) {
  ASSERT_TRUE(used());
  const std::string text = read_file(run_);
  const std::string body = text.substr(0, text.rfind(",\"checksum\":\""));
  Mutations mutations(3);
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE(k);
    const std::string changed = mutations.text(body);
    write(run_, changed + ",\"checksum\":\"" + hash_text(changed) + "\"}\n");
    ASSERT_NO_THROW(static_cast<void>(used()));
  }
}

TEST_F(MutatedStudy, Plans) {
  const std::string text = read_file(plan_path(folder_));
  Mutations mutations(4);
  int read = 0;
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE(k);
    write(plan_path(folder_), mutations.text(text));
    ASSERT_NO_THROW(read += used() ? 1 : 0);
  }
  EXPECT_LT(read, 200);
}

TEST_F(MutatedStudy, MapsOfMoreCellsThanThereAreAreRefused) {
  std::string text = read_file(run_);
  text = text.substr(0, text.rfind(",\"checksum\":\""));
  const std::size_t map = text.find("\"map\":[");
  for (const char* cells : {"2,99999999999999999", "9,3", "2,-1", "-1,1"}) {
    const std::string changed = text.substr(0, map) + "\"map\":[" + cells + "]";
    EXPECT_THROW(read_run_json(changed + ",\"checksum\":\"" + hash_text(changed) + "\"}\n",
                               run_input(read_plan(folder_))),
                 InputError)
        << cells;
  }
}

}  // namespace
}  // namespace keyblock::study
