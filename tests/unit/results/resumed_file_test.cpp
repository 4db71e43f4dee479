#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "killed_process.h"
#include "results/result_writer.h"
#include "results/run_data.h"
#include "sample_run.h"

namespace keyblock::results {
namespace {

constexpr double seldom = 1e9;  // s between flushes

TEST(ResumedFile, HoldsAllThatWasReportedByACheckpoint) {
  const FreshFolder folder;
  SampleRun sample;
  in_killed_process([&] {
    ResultWriter writer(folder, seldom);
    sample.play(writer, 1, 17, false);
    writer.checkpoint();
    writer.step(sample.step_row(1, 18));
    ::kill(::getpid(), SIGKILL);
  });
  const RunData data = read_run(folder);
  EXPECT_EQ(data.steps.size(), 17U);
  EXPECT_EQ(data.histories.size(), 17U);
  EXPECT_EQ(data.frames.size(), 3U);
}

TEST(ResumedFile, AResumedRunGoesOnFromItsCheckpoint) {
  const FreshFolder folder;
  SampleRun sample;
  in_killed_process([&] {
    ResultWriter writer(folder, 0.0);
    sample.play(writer, 1, 27, false);
    ::kill(::getpid(), SIGKILL);
  });
  {
    ResultWriter writer(folder);
    sample.play(writer, 19, 30);  // from a checkpoint at step 18
  }
  expect_equal(read_run(folder), sample.expected());
}

TEST(ResumedFile, AResumedRunThatIsKilledKeepsWhatTheEarlierOneDid) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  in_killed_process([&] {
    ResultWriter writer(folder, seldom);
    sample.play(writer, 19, 20, false);
    ::kill(::getpid(), SIGKILL);
  });
  const RunData data = read_run(folder);
  EXPECT_EQ(data.steps.size(), 18U);
  EXPECT_EQ(data.histories.size(), 18U);
  EXPECT_EQ(data.frames.size(), 3U);
  ASSERT_EQ(data.run.stages.size(), 2U);
  EXPECT_FALSE(data.run.stages[0].interrupted);
}

// Of a run that is interrupted at the step of its checkpoint, the end is reported at that step, too.
TEST(ResumedFile, WhatWasReportedAfterTheCheckpointIsNotKept) {
  for (const long checkpoint : {10L, 20L, 25L}) {
    const FreshFolder folder;
    SampleRun sample;
    {
      ResultWriter writer(folder);
      sample.play(writer, 1, checkpoint, false);
      if (checkpoint == 10) writer.stage_begin(1, sample.stage(1));
      writer.frame(sample.frame(1, checkpoint));
      writer.contacts(sample.contacts(1, checkpoint, 2));
      writer.stage_end(1, sample.stage(1));
      writer.end(sample.run());
    }
    ResultWriter writer(folder);
    sample.play(writer, checkpoint + 1, 30);
    expect_equal(read_run(folder), sample.expected());
  }
}

TEST(ResumedFile, AResumedRunThatReportsNothingKeepsWhatTheEarlierOneDid) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  {
    ResultWriter writer(folder);
    sample.play(writer, 31, 30);
  }
  expect_equal(read_run(folder), sample.expected());
  {
    ResultWriter writer(folder);
    sample.play(writer, 19, 18);
  }
  const RunData data = read_run(folder);
  EXPECT_EQ(data.steps.size(), 18U);
  EXPECT_EQ(data.frames.size(), 3U);
  ASSERT_EQ(data.run.stages.size(), 2U);
  EXPECT_FALSE(data.run.stages[0].interrupted);
  EXPECT_TRUE(data.run.stages[1].interrupted);
}

TEST(ResumedFile, ResumingWithLessThanTheCheckpointKnowsOfIsRefused) {
  const FreshFolder folder;
  SampleRun sample;
  in_killed_process([&] {
    ResultWriter writer(folder, 0.0);
    sample.play(writer, 1, 17, false);
  });
  const std::string before = read_file(folder / "result.h5");
  {
    ResultWriter writer(folder);
    EXPECT_THROW(sample.play(writer, 26, 30), InputError);
  }
  EXPECT_EQ(read_file(folder / "result.h5"), before);
}

TEST(ResumedFile, ResumingWithoutEarlierResultsIsRefused) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    EXPECT_THROW(sample.play(writer, 19, 30), InputError);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(ResumedFile, ResumingAnotherModelIsRefusedAndLeavesTheResultsAlone) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  {
    SampleRun other;
    other.model.vertices[0].x += 1.0;
    ResultWriter writer(folder);
    EXPECT_THROW(other.play(writer, 19), InputError);
  }
  expect_equal(read_run(folder), sample.expected());
  EXPECT_FALSE(std::filesystem::exists(folder / fmt::format("result.h5.{}.tmp", ::getpid())));
}

}  // namespace
}  // namespace keyblock::results
