#include "study/slurm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "core/error.h"
#include "study/array_index.h"

namespace keyblock::study {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(IndexRanges, AreShort) {
  EXPECT_EQ(index_ranges({}), "");
  EXPECT_EQ(index_ranges({5}), "5");
  EXPECT_EQ(index_ranges({3, 7, 8, 9, 20}), "3,7-9,20");
}

TEST(ArrayScripts, OneTaskForARun) {
  SlurmOptions options;
  options.program = "/opt/it's/keyblock";
  options.most_running = 8;
  options.partition = "long";
  const auto scripts = array_scripts("/data/a b", {3, 7, 8}, options);
  ASSERT_EQ(scripts.size(), 1U);
  EXPECT_EQ(scripts[0].name, "array.sbatch");
  EXPECT_EQ(scripts[0].elements, "3,7-8%8");
  EXPECT_THAT(scripts[0].text, HasSubstr("#SBATCH --array=3,7-8%8\n"));
  EXPECT_THAT(scripts[0].text, HasSubstr("#SBATCH --partition=long\n"));
  EXPECT_THAT(scripts[0].text, HasSubstr("#SBATCH --output=\"/data/a b/slurm/%A_%a.log\"\n"));
  EXPECT_THAT(scripts[0].text,
              HasSubstr("exec '/opt/it'\\''s/keyblock' study task '/data/a b' $((SLURM_ARRAY_TASK_ID))\n"));
  EXPECT_THAT(scripts[0].text, Not(HasSubstr("--mem")));
  EXPECT_THAT(collect_script("/data/a b", options), HasSubstr("study collect '/data/a b'\n"));
}

TEST(ArrayScripts, SeveralWhereSlurmTakesNoLargerIndex) {
  SlurmOptions options;
  options.program = "keyblock";
  options.most_elements = 1000;
  std::vector<std::size_t> runs(2500);
  std::iota(runs.begin(), runs.end(), std::size_t{0});
  runs.erase(runs.begin() + 1200);
  const auto scripts = array_scripts("/d", runs, options);
  ASSERT_EQ(scripts.size(), 3U);
  EXPECT_EQ(scripts[0].elements, "0-999");
  EXPECT_EQ(scripts[1].elements, "0-199,201-999");
  EXPECT_EQ(scripts[2].elements, "0-499");
  EXPECT_EQ(scripts[1].name, "array-2.sbatch");
  EXPECT_THAT(scripts[1].text, HasSubstr("$(((SLURM_ARRAY_TASK_ID + 1000)))"));
}

TEST(ArrayScripts, SeveralRunsForATask) {
  SlurmOptions options;
  options.program = "keyblock";
  options.runs_per_task = 10;
  options.most_elements = 4;
  const auto scripts = array_scripts("/d", {0, 1, 2, 15, 47}, options);
  ASSERT_EQ(scripts.size(), 2U);
  EXPECT_EQ(scripts[0].elements, "0-1");
  EXPECT_EQ(scripts[1].elements, "0");
  EXPECT_THAT(scripts[1].text, HasSubstr("first=$(((SLURM_ARRAY_TASK_ID + 4) * 10))"));
  EXPECT_THAT(scripts[1].text, HasSubstr("run <= 47;"));
}

TEST(ArrayScripts, WhatSbatchCannotTakeIsRefused) {
  SlurmOptions options;
  options.program = "keyblock";
  const auto scripts = array_scripts("/data/100%A", {0}, options);
  EXPECT_THAT(scripts[0].text, HasSubstr("#SBATCH --output=\"/data/100%%A/slurm/%A_%a.log\"\n"));
  EXPECT_THAT(collect_script("/data/100%A", options), HasSubstr("\"/data/100%%A/slurm/%j.log\"\n"));
  for (const char* folder : {"/data/a\"b", "/data/a\\b", "/data/a\nb"})
    EXPECT_THROW(array_scripts(folder, {0}, options), InputError);
  options.most_elements = 0;
  EXPECT_THROW(array_scripts("/data", {0}, options), InputError);
}

TEST(ArrayScripts, AreKnownByTheirNames) {
  for (const char* name : {"array.sbatch", "array-2.sbatch", "array-31.sbatch"})
    EXPECT_TRUE(is_array_script(name));
  for (const char* name :
       {"array-.sbatch", "array2.sbatch", "array-mine.sbatch", "array.sbatch.txt", "collect.sbatch"})
    EXPECT_FALSE(is_array_script(name));
}

TEST(MaxArraySize, OfTheConfiguration) {
  EXPECT_EQ(max_array_size("KillWait = 30 sec\nMaxArraySize            = 4001\nMaxJobCount = 10000\n"),
            4001U);
  EXPECT_EQ(max_array_size("MaxArraySize = 0\n"), 0U);
  EXPECT_FALSE(max_array_size("MaxArraySize = 99999999999999999999999\n"));
  EXPECT_FALSE(max_array_size(""));
}

TEST(ArrayIndex, GivenOrOfTheEnvironment) {
  EXPECT_EQ(array_index("7", 0, 8), 7U);
  EXPECT_EQ(array_index("8", 1, 8), 7U);
  EXPECT_THROW(array_index("8", 0, 8), InputError);
  EXPECT_THROW(array_index("0", 1, 8), InputError);
  EXPECT_THROW(array_index("-1", 0, 8), InputError);
  EXPECT_THROW(array_index("3x", 0, 8), InputError);
  EXPECT_THROW(array_index("", 0, 8), InputError);
  ::setenv("SGE_TASK_ID", "undefined", 1);  // NOLINT(concurrency-mt-unsafe)
  ::setenv("LSB_JOBINDEX", "4", 1);         // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(array_index("", 1, 8), 3U);
  EXPECT_EQ(array_index("2", 1, 8), 1U);
  ::setenv("SGE_TASK_ID", "9", 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_THROW(array_index("", 0, 8), InputError);
  ::unsetenv("SGE_TASK_ID");   // NOLINT(concurrency-mt-unsafe)
  ::unsetenv("LSB_JOBINDEX");  // NOLINT(concurrency-mt-unsafe)
}

}  // namespace
}  // namespace keyblock::study
