#include "study/workers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/folder.h"
#include "study/collect.h"
#include "study/folder.h"
#include "study/run_json.h"

namespace keyblock::study {
namespace {

// Runs 0 and 1 agree, which is enough, and take a while to end once their results are there; run 2 finds that it is not asked for.
TEST(Workers, ARunThatIsNotAskedForAnyMoreHasNotFailed) {
  const FreshFolder folder;
  Plan plan;
  plan.stage = "after";
  plan.until = scenario::UntilSpec{"fallen_area_m2", std::nullopt, 1.0, 2, 3};
  for (int k = 0; k < 3; ++k) {
    plan.runs.push_back({"k" + std::to_string(k), k, {{"1"}}, "", true});
    RunResult result = empty_result(plan.runs.back());
    result.stages.push_back({"after", record::StageKind::rest, 0.0, 0.0, 0.0, {}});
    write_file_atomically(folder / (result.key + ".json"), run_json(result, run_input(plan)));
  }
  WorkerOptions options;
  options.workers = 3;
  options.command = {
      "/bin/sh", "-c",
      "cd \"$1\"; "
      "if [ $2 = 2 ]; then until [ -e runs/k0/run.json ] && [ -e runs/k1/run.json ]; do sleep 0.01; done; "
      "else cp k$2.json runs/k$2/new; mv runs/k$2/new runs/k$2/run.json; sleep 0.3; fi",
      "sh"};
  StudyFiles files = read_study_files(folder, plan);
  const WorkerOutcome outcome = run_workers(folder, plan, files, options);
  EXPECT_THAT(outcome.failed, testing::IsEmpty());
  EXPECT_EQ(outcome.done, 2U);
  EXPECT_EQ(files.enough, 2);
  EXPECT_FALSE(file_exists(folder / "runs" / "k2" / "failed.json"));
}

}  // namespace
}  // namespace keyblock::study
