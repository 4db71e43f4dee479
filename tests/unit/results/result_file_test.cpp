#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/error.h"
#include "killed_process.h"
#include "results/record_json.h"
#include "results/result_writer.h"
#include "results/run_data.h"
#include "sample_run.h"

// HDF5 does not give back all its memory where it finds a file damaged.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(readability-identifier-naming)
  return "leak:libhdf5";
}

namespace keyblock::results {
namespace {

using testing::HasSubstr;

constexpr double never = 1e9;  // s between flushes

std::string error_of(const std::filesystem::path& folder) {
  try {
    read_run(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::filesystem::path temporary_in(const std::filesystem::path& folder) {
  return folder / fmt::format("result.h5.{}.tmp", ::getpid());
}

TEST(ResultFile, ComesBackToTheLastBit) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  expect_equal(read_run(folder), sample.expected());
  EXPECT_EQ(read_histories(folder).size(), 30U);
  EXPECT_TRUE(std::filesystem::exists(folder / "summary.json"));
  EXPECT_TRUE(std::filesystem::exists(folder / "histories.csv"));
  EXPECT_FALSE(std::filesystem::exists(temporary_in(folder)));
}

TEST(ResultFile, ARunHasEndedWhenAllIsWritten) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  EXPECT_TRUE(has_ended(folder));
  write_file_atomically(folder / "summary.json", "of an earlier end");
  EXPECT_FALSE(has_ended(folder));
  std::filesystem::remove(folder / "summary.json");
  EXPECT_FALSE(has_ended(folder));
  record::RunRecord part = sample.run();
  part.interrupted = true;
  {
    ResultWriter writer(folder);
    sample.play(writer, 1, 30, false);
    writer.end(part);
  }
  EXPECT_FALSE(has_ended(folder));
}

TEST(ResultFile, FilesOfEarlierVersionsDoNotSayWhereTheLargestOverlapIs) {
  SampleRun sample;
  auto written = nlohmann::ordered_json::parse(run_json(sample.run()));
  for (const char* name : {"max_overlap_at", "contact_checks"}) ASSERT_EQ(written.erase(name), 1U);
  const record::RunRecord run = read_run_json(written.dump());
  EXPECT_EQ(run.max_overlap.depth, sample.run().max_overlap.depth);
  EXPECT_EQ(run.max_overlap.block_a, -1);
}

TEST(ResultFile, HowOftenItIsFlushedDoesNotShow) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder, 0.0);  // after every event
    sample.play(writer);
  }
  expect_equal(read_run(folder), sample.expected());
}

TEST(ResultFile, ARunWithoutContactsHistoriesOrFrames) {
  const FreshFolder folder;
  SampleRun sample;
  sample.model.history_names.clear();
  sample.model.element_histories.clear();
  record::RunRecord run = sample.run();
  {
    ResultWriter writer(folder);
    writer.begin(sample.model);
    record::HistoryRow row;
    row.step = 4;
    writer.history(row);
    writer.end(run);
  }
  const RunData data = read_run(folder);
  EXPECT_TRUE(data.frames.empty());
  EXPECT_TRUE(data.contacts.empty());
  ASSERT_EQ(data.histories.size(), 1U);
  EXPECT_TRUE(data.histories[0].points.empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "histories.csv"));
}

TEST(ResultFile, ManyRows) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder, never);
    writer.begin(sample.model);
    for (long step = 1; step <= 20000; ++step) writer.history(sample.history(step));
    for (long step = 1; step <= 300; ++step) writer.contacts(sample.contacts(0, step, 100));
    writer.end(sample.run());
  }
  const RunData data = read_run(folder);
  ASSERT_EQ(data.histories.size(), 20000U);
  EXPECT_EQ(data.histories[19999].points[1].ux, sample.history(20000).points[1].ux);
  ASSERT_EQ(data.contacts.size(), 300U);
  EXPECT_EQ(data.contacts[299].contacts[99].gap, sample.contacts(0, 300, 100).contacts[99].gap);
}

TEST(ResultFile, SurvivesBeingKilled) {
  const FreshFolder folder;
  SampleRun sample;
  // Flushed at the end of stage 0 (step 10) alone.
  in_killed_process([&] {
    ResultWriter writer(folder, never);
    sample.play(writer, 1, 23, false);
    ::kill(::getpid(), SIGKILL);
  });
  RunData data = read_run(folder);
  EXPECT_TRUE(data.run.interrupted);
  ASSERT_EQ(data.run.stages.size(), 1U);
  EXPECT_EQ(data.run.stages[0].steps, 10);
  EXPECT_EQ(data.run.steps, 10);
  RunData expected = sample.expected();
  expected.frames.resize(2);
  expected.contacts.resize(1);
  expected.histories.resize(10);
  expected.breaks.resize(1);
  expected.steps.resize(10);
  ASSERT_EQ(data.run.breaks.size(), 1U);
  EXPECT_EQ(data.run.breaks[0].events, 1);
  expected.run = data.run;
  expected.run.stages = {sample.stage(0)};
  expect_equal(data, expected);
}

TEST(ResultFile, KilledWithinAStageTellsWhichAndHowFar) {
  const FreshFolder folder;
  SampleRun sample;
  in_killed_process([&] {
    ResultWriter writer(folder, 0.0);
    sample.play(writer, 1, 23, false);
    ::kill(::getpid(), SIGKILL);
  });
  const RunData data = read_run(folder);
  // Every event flushes those before it.
  ASSERT_EQ(data.frames.size(), 4U);
  EXPECT_EQ(data.steps.size(), 23U);
  EXPECT_EQ(data.histories.size(), 22U);
  ASSERT_EQ(data.run.stages.size(), 2U);
  EXPECT_FALSE(data.run.stages[0].interrupted);
  EXPECT_TRUE(data.run.stages[1].interrupted);
  EXPECT_EQ(data.run.stages[1].steps, 13);
  EXPECT_EQ(data.run.steps, 23);
  EXPECT_DOUBLE_EQ(data.run.stages[1].duration, sample.step_row(1, 23).time);
  EXPECT_EQ(data.run.stages[1].planned_duration, sample.stage(1).planned_duration);
  EXPECT_EQ(data.run.stages[1].motion, sample.stage(1).motion);
  EXPECT_EQ(data.run.energy.kinetic, sample.step_row(1, 23).energy.kinetic);
}

// What nothing in the file tells is not 0.
TEST(ResultFile, OfAKilledRunWhatIsNotKnownIsNoNumber) {
  const FreshFolder folder;
  SampleRun sample;
  sample.model.blocks[0].fixed = false;
  in_killed_process([&] {
    ResultWriter writer(folder, 0.0);
    sample.play(writer, 1, 23, false);
    ::kill(::getpid(), SIGKILL);
  });
  const RunData data = read_run(folder);
  EXPECT_TRUE(data.cut_off);
  EXPECT_TRUE(std::isnan(data.run.wall_time));
  EXPECT_TRUE(std::isnan(data.run.max_overlap.depth));
  EXPECT_TRUE(std::isnan(data.run.max_area_change));
  EXPECT_EQ(data.run.energy.residual_ratio, sample.step_row(1, 23).energy.residual_ratio);
  const record::StageRecord& last = data.run.stages.at(1);
  EXPECT_TRUE(std::isnan(last.wall_time));
  // In its last frame, of step 20, block 1 is loosened and block 2 has fallen.
  EXPECT_EQ(last.damage.fallen_blocks, 1);
  EXPECT_EQ(last.damage.fallen_area, sample.model.blocks[2].area);
  EXPECT_EQ(last.damage.loosened_area, sample.model.blocks[1].area);
  EXPECT_TRUE(std::isnan(last.damage.slip_max));
  EXPECT_TRUE(std::isnan(last.damage.opening_filled_ratio));
  // Orders of that frame: 21, 22, 23.
  EXPECT_EQ(data.run.dof, 22 * 23 + 23 * 24 + 24 * 25);
  EXPECT_EQ(data.run.stages[0].wall_time, sample.stage(0).wall_time);
  {
    ResultWriter writer(folder);
    sample.play(writer, 19, 30);
  }
  EXPECT_FALSE(read_run(folder).cut_off);
}

// The kill may come at any moment, in the middle of a flush, too: some time after the file is there, or after so many frames.
TEST(ResultFile, SurvivesAKillAtAnyMoment) {
  const FreshFolder folder;
  SampleRun sample;
  int with_frames = 0;
  for (int round = 0; round < 40; ++round) {
    std::filesystem::remove(folder / "result.h5");
    int frames[2];  // a byte for each that is written
    ASSERT_EQ(::pipe(frames), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ResultWriter writer(folder, 0.0);
      writer.begin(sample.model);
      for (long step = 1;; ++step) {
        writer.history(sample.history(step));
        writer.contacts(sample.contacts(0, step, 50));
        writer.frame(sample.frame(0, step));
        if (::write(frames[1], "", 1) != 1) ::_exit(1);
      }
    }
    ::close(frames[1]);  // or a child that ends early would be waited for
    const int at_least = round / 4;
    char byte = 0;
    for (int k = 0; k < at_least; ++k) ASSERT_EQ(::read(frames[0], &byte, 1), 1);
    while (!std::filesystem::exists(folder / "result.h5")) ::usleep(500);
    ::usleep(static_cast<useconds_t>(170 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(frames[0]);
    const RunData data = read_run(folder);
    with_frames += data.frames.empty() ? 0 : 1;
    for (std::size_t k = 0; k < data.frames.size(); ++k) {
      const auto expected = sample.frame(0, static_cast<long>(k) + 1);
      ASSERT_EQ(data.frames[k].step, expected.step);
      ASSERT_EQ(data.frames[k].displacement, expected.displacement);
      ASSERT_EQ(data.frames[k].status, expected.status);
    }
    for (std::size_t k = 0; k < data.contacts.size(); ++k) {
      const auto expected = sample.contacts(0, static_cast<long>(k) + 1, 50);
      ASSERT_EQ(data.contacts[k].contacts[49].gap, expected.contacts[49].gap);
      ASSERT_EQ(data.contacts[k].contacts[49].shear_force, expected.contacts[49].shear_force);
    }
    for (std::size_t k = 0; k < data.histories.size(); ++k) {
      ASSERT_EQ(data.histories[k].points[1].sxx, sample.history(static_cast<long>(k) + 1).points[1].sxx);
    }
  }
  EXPECT_GE(with_frames, 30);  // a flush may come a frame later
}

TEST(ResultFile, CanBeReadWhileTheRunGoesOn) {
  const FreshFolder folder;
  SampleRun sample;
  ResultWriter writer(folder, 0.0);
  sample.play(writer, 1, 12, false);
  const RunData data = read_run(folder);
  EXPECT_EQ(data.frames.size(), 2U);
  EXPECT_TRUE(data.run.interrupted);
}

TEST(ResultFile, FilesOfTheUserUnderItsTemporaryNamesStay) {
  const FreshFolder folder;
  write_file_atomically(folder / "result.h5.tmp", "mine");
  write_file_atomically(folder / "precious", "mine");
  std::filesystem::create_symlink("precious", temporary_in(folder));
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  expect_equal(read_run(folder), sample.expected());
  EXPECT_EQ(read_file(folder / "result.h5.tmp"), "mine");
  EXPECT_EQ(read_file(folder / "precious"), "mine");
}

TEST(ResultFile, TellsBeforeItTakesThePlaceOfAnother) {
  const FreshFolder folder;
  SampleRun sample;
  int calls = 0;
  ResultWriter writer(folder);
  writer.before_publishing([&] {
    ++calls;
    EXPECT_TRUE(std::filesystem::exists(temporary_in(folder)));
    EXPECT_FALSE(std::filesystem::exists(folder / "result.h5"));
  });
  sample.play(writer);
  EXPECT_EQ(calls, 1);
}

// Of a file that ends before the model does, nothing is left.
TEST(ResultFile, AFileThatCannotBeCreatedLeavesNothing) {
  const FreshFolder folder;
  SampleRun sample;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};  // bytes
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      ResultWriter writer(folder);
      writer.begin(sample.model);
    } catch (const RunError&) {
      ::_exit(std::filesystem::is_empty(folder) ? 0 : 2);
    }
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(ResultFile, AFailedStartLeavesEarlierResultsAlone) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  {
    ResultWriter writer(folder);
    writer.begin(sample.model);
    writer.stage_begin(0, sample.stage(0));
  }
  expect_equal(read_run(folder), sample.expected());
}

TEST(ResultFile, WhatIsNoResultFileIsNamed) {
  const FreshFolder folder;
  EXPECT_THAT(error_of(folder), HasSubstr("result.h5: found no such file"));
  std::ofstream(folder / "result.h5") << "hello";
  EXPECT_THAT(error_of(folder), HasSubstr("no HDF5 file"));
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  const std::string whole = read_file(folder / "result.h5");
  for (const std::size_t size : {std::size_t{20}, std::size_t{3000}, whole.size() / 2, whole.size() - 100}) {
    std::ofstream(folder / "result.h5", std::ios::binary)
        .write(whole.data(), static_cast<std::streamsize>(size));
    EXPECT_THAT(error_of(folder), HasSubstr("result.h5")) << size;
  }
}

// Whatever byte is wrong: the file is refused, or the byte is not looked at.
TEST(ResultFile, AWrongByteIsFound) {
  const FreshFolder folder;
  SampleRun sample;
  {
    ResultWriter writer(folder);
    sample.play(writer);
  }
  const RunData expected = read_run(folder);
  const std::string whole = read_file(folder / "result.h5");
  int refused = 0;
  for (std::size_t k = 0; k < whole.size(); k += 331) {
    std::string damaged = whole;
    damaged[k] = static_cast<char>(damaged[k] ^ 0x41);
    std::ofstream(folder / "result.h5", std::ios::binary) << damaged;
    try {
      expect_equal(read_run(folder), expected);
    } catch (const InputError&) {
      ++refused;
    }
    ASSERT_FALSE(HasFailure()) << "byte " << k;
  }
  EXPECT_GT(refused, 20);
}

TEST(ResultFile, PlacesThatAreNotThereAreRefused) {
  const auto error_with = [](const auto& change, const std::string& name) {
    const FreshFolder folder;
    SampleRun sample;
    change(sample.model);
    {
      ResultWriter writer(folder);
      sample.play(writer);
    }
    EXPECT_THAT(error_of(folder), HasSubstr(name));
  };
  using Model = record::ModelRecord;
  for (const std::vector<int>& start : {std::vector<int>{3, 1, 11}, {3, 5, 11}, {-3, 7, 11}, {3, 7, 15}})
    error_with([&](Model& model) { model.blocks[1].ring_start = start; }, "model/ring_start");
  error_with([](Model& model) { model.blocks[1].excavations = {2}; }, "model/excavation");
  error_with([](Model& model) { model.edge_label.pop_back(); }, "model/edge_kind");
}

TEST(ResultFile, AFolderThatCannotBeWrittenIsARunError) {
  const FreshFolder folder;
  std::ofstream(folder / "file") << "x";
  SampleRun sample;
  ResultWriter writer(folder / "file" / "out");
  EXPECT_THROW(writer.begin(sample.model), RunError);
}

TEST(ResultFile, FramesOfAnotherModelAreRefused) {
  const FreshFolder folder;
  SampleRun sample;
  ResultWriter writer(folder);
  writer.begin(sample.model);
  record::Frame frame = sample.frame(0, 1);
  frame.stress.pop_back();
  EXPECT_THROW(writer.frame(frame), std::invalid_argument);
}

}  // namespace
}  // namespace keyblock::results
