#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <functional>
#include <string>

#include "../fresh_folder.h"
#include "../mutations.h"
#include "../scene.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "simulation/checkpoint.h"

namespace keyblock::simulation {
namespace {

/// Ends a run after so many steps.
struct FewSteps final : record::RunObserver {
  explicit FewSteps(long count) : left(count) {}
  void progress(const record::Progress& /*unused*/) override {
    if (--left <= 0) stop = true;
  }
  long left;
  std::atomic<bool> stop = false;
};

/// Two blocks on a fixed one, of which one is excavated.
RunSetup mutated_scene() {
  Scene scene(1e9, 30.0);
  scene.rectangle({-2.0, -1.0}, 4.0, 1.0, 0.0, true);
  scene.rectangle({-1.0, 0.0}, 1.0, 1.0);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5, 0.0, false, 2);
  scene.setup.gravity = {0.0, -g};
  scene.setup.time_step = 0.002;
  scene.setup.excavations.push_back({"above", {{-1.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}}});
  scene.setup.properties[1].automatic_order = true;
  return scene.setup;
}

class MutatedCheckpoint : public ::testing::Test {
 protected:
  /// The bytes of the checkpoint that a run of the setup has left when it is stopped.
  std::string checkpoint_of(const RunSetup& setup, long steps) {
    FewSteps observer(steps);
    run(setup, options(observer, false), observer);
    return read_file(checkpoint_path(folder_));
  }

  /// What becomes of a run that goes on from these bytes, whose hash is made right.
  std::string resumed(const RunSetup& setup, std::string bytes) {
    if (bytes.size() >= sizeof(std::uint64_t)) {
      Hash hash;
      hash.add(bytes.data(), bytes.size() - sizeof(std::uint64_t));
      const std::uint64_t value = hash.value();
      std::memcpy(bytes.data() + bytes.size() - sizeof(value), &value, sizeof(value));
    }
    write_file_atomically(checkpoint_path(folder_), bytes);
    FewSteps observer(4);
    try {
      run(setup, options(observer, true), observer);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("to begin anew, run into another folder"));
      return "refused";
    } catch (const RunError&) {
      return "given up";
    }
    return "went on";
  }

  void mutate(const RunSetup& setup, const std::string& bytes, int count) {
    ASSERT_EQ(resumed(setup, bytes), "went on");
    Mutations mutations(bytes.size());
    for (int k = 0; k < count; ++k) {
      const std::string changed = mutations(bytes);
      SCOPED_TRACE(k);
      ASSERT_NO_THROW(resumed(setup, changed));
    }
  }

 private:
  RunOptions options(FewSteps& observer, bool resume) const {
    RunOptions options;
    options.directory = folder_;
    options.progress_interval = 0.0;
    options.stop = &observer.stop;
    options.resume = resume;
    return options;
  }

  const FreshFolder folder_;
};

TEST_F(MutatedCheckpoint, AtTheEndOfAStage) {
  RunSetup setup = mutated_scene();
  setup.stages = {stage("in situ", record::StageKind::settle), stage("after", record::StageKind::rest, 1.0)};
  setup.stages[0].excavate = {0};
  mutate(setup, checkpoint_of(setup, 400), 300);
}

TEST_F(MutatedCheckpoint, WithinAStageOfTheNewmarkFamily) {
  RunSetup setup = mutated_scene();
  setup.solver.integrator = dynamics::TimeIntegration::average_acceleration;
  setup.stages = {stage("rest", record::StageKind::rest, 10.0)};
  mutate(setup, checkpoint_of(setup, 2100), 300);
}

TEST_F(MutatedCheckpoint, WithinAStageThatSettles) {
  RunSetup setup = mutated_scene();
  setup.stages = {stage("in situ", record::StageKind::settle)};
  setup.stages[0].tolerance = 1e-30;
  setup.stages[0].max_steps = 2500;
  mutate(setup, checkpoint_of(setup, 2100), 300);
}

TEST_F(MutatedCheckpoint, OfAnExcavationOpenedInParts) {
  RunSetup setup = mutated_scene();
  setup.system.blocks[2].excavations = {0};
  setup.excavations[0].outline = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.5}, {0.0, 0.5}};
  setup.excavations[0].pressure.constant = 1e3;
  setup.stages = {stage("in situ", record::StageKind::settle), stage("open", record::StageKind::settle),
                  stage("after", record::StageKind::rest, 1.0)};
  setup.stages[1].excavate = {0};
  setup.stages[1].release = {{0, 0.5}};
  mutate(setup, checkpoint_of(setup, 200), 300);
}

// More than the file could hold, so that no memory is asked for.
TEST_F(MutatedCheckpoint, CountsBeyondTheFileAreRefused) {
  RunSetup setup = mutated_scene();
  setup.stages = {stage("after", record::StageKind::rest, 1.0), stage("later", record::StageKind::rest, 1.0)};
  const std::string bytes = checkpoint_of(setup, 600);
  constexpr std::size_t count_of_positions = 2 * sizeof(std::uint64_t) + 3 * sizeof(double);
  for (const std::uint64_t count :
       {std::uint64_t{bytes.size()}, std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
    std::string changed = bytes;
    std::memcpy(&changed[count_of_positions], &count, sizeof(count));
    EXPECT_EQ(resumed(setup, changed), "refused");
  }
  for (std::size_t size = 0; size < bytes.size(); size += 97)
    EXPECT_EQ(resumed(setup, bytes.substr(0, size)), "refused") << size;
}

}  // namespace
}  // namespace keyblock::simulation
