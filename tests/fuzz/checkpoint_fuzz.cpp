// A run that goes on from a checkpoint that was changed: the bytes are a list of changes to one that is right, so that they reach what
// lies behind its first lines whatever the format of checkpoints becomes.
#include <atomic>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "places.h"
#include "scenario/build.h"
#include "scenario/parse.h"
#include "simulation/checkpoint.h"
#include "simulation/run.h"
#include "try.h"

namespace keyblock::fuzz {
namespace {

constexpr const char* scenario_text = R"(
title = "A block that slides"
[rock]
density = 2600.0
young = 1.0e9
poisson = 0.2
state = "plane-stress"
[joints]
friction = 20.0
[time]
step = 0.001
[[block]]
name = "base"
outer = [[0.0, 0.0], [10.0, 0.0], [10.0, -1.0], [0.0, -1.0]]
fixed = true
[[block]]
name = "slider"
outer = [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]]
[[stage]]
name = "first"
kind = "settle"
max_steps = 3
[[stage]]
name = "second"
kind = "rest"
duration = 0.002
)";

constexpr std::size_t header =
    2 * sizeof(std::uint64_t);  // format and fingerprint, which are looked at first

/// Stops the run at the end of its first stage.
struct StopsAfterFirst : record::RunObserver {
  std::atomic<bool> stop = false;
  void stage_end(int, const record::StageRecord&) override { stop = true; }
};

/// A run of two stages, and the checkpoint at the end of the first.
struct Fixed {
  TemporaryFolder folder;
  simulation::RunSetup setup =
      scenario::build_setup(scenario::parse_scenario_text(scenario_text, "fuzz.toml"), 0);
  simulation::RunOptions options;
  std::string checkpoint;

  Fixed() {
    StopsAfterFirst observer;
    options.directory = folder.path();
    options.stop = &observer.stop;
    simulation::run(setup, options, observer);
    checkpoint = read_file(simulation::checkpoint_path(folder.path()));
    options.resume = true;
    options.stop = nullptr;
  }
};

/// Each change has ten bytes: a place, and what stands there then. A place behind the end gives the file another length.
std::string changed(std::string file, std::string_view changes) {
  constexpr std::size_t place_size = sizeof(std::uint16_t), value_size = sizeof(std::uint64_t);
  while (changes.size() >= place_size + value_size) {
    std::uint16_t place = 0;
    std::uint64_t value = 0;
    std::memcpy(&place, changes.data(), place_size);
    std::memcpy(&value, changes.data() + place_size, value_size);
    changes.remove_prefix(place_size + value_size);
    const std::size_t at = header + place;
    if (at + 2 * value_size <= file.size()) {
      std::memcpy(file.data() + at, &value, value_size);
    } else {
      file.resize(header + value_size + value % (2 * file.size()));
    }
  }
  return file;
}

/// With the hash at its end put right.
void sign(std::string& file) {
  const std::size_t size = file.size() - sizeof(std::uint64_t);
  Hash hash;
  hash.add(file.data(), size);
  const std::uint64_t value = hash.value();
  std::memcpy(file.data() + size, &value, sizeof value);
}

}  // namespace

void try_bytes(std::string_view bytes) {
  static const Fixed fixed;
  std::string file = changed(fixed.checkpoint, bytes);
  sign(file);
  write(simulation::checkpoint_path(fixed.folder.path()), file);
  record::RunObserver nobody;
  simulation::run(fixed.setup, fixed.options, nobody);
}

}  // namespace keyblock::fuzz
