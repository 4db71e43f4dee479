#pragma once
#include <filesystem>
#include <string>

#include "model/state.h"
#include "record/record.h"
#include "simulation/control.h"
#include "simulation/damage.h"
#include "simulation/elements.h"
#include "simulation/order_control.h"
#include "simulation/settle.h"
#include "simulation/setup.h"
#include "simulation/staged_opening.h"
#include "simulation/stillness.h"

namespace keyblock::simulation {

/// All that a run needs to go on as if it had never stopped.
struct RunState {
  dynamics::State mechanics;
  std::vector<std::uint8_t> present;  ///< per block
  DamageGauge::Memory damage;
  OrderControl::Memory orders;
  StagedOpening::Memory opening;
  Settler::Memory settler;  ///< of the stage at hand, if it is a settle stage
  Stillness::Memory still;  ///< of the stage at hand, if it ends when all is still
  ControlMemory control;
  std::vector<ElementPeak> peaks;  ///< of all elements; empty before the first step
  int stage = 0;
  long stage_step = 0;          ///< steps done in it
  double stage_start = 0.0;     ///< s, simulated time at which it began
  double initial_energy = 0.0;  ///< J
  double wall_time = 0.0;       ///< s
  long iterations = 0;
  record::Reported reported;
  record::RunRecord record;  ///< what has been summed up so far, with the stages that have ended
};

std::filesystem::path checkpoint_path(const std::filesystem::path& directory);

/// DIR/checkpoint.bin. Written atomically. Reading throws InputError when there is none, when it is damaged, or when it
/// belongs to another setup or version.
void write_checkpoint(const std::filesystem::path& directory, const RunSetup& setup, const RunState& state);
RunState read_checkpoint(const std::filesystem::path& directory, const RunSetup& setup);

/// Throws InputError about the checkpoint in the folder, with what to do.
[[noreturn]] void refuse_checkpoint(const std::filesystem::path& directory, std::string found,
                                    std::string expected);

/// Hash of positions, velocities and contact memory: equal for equal bits.
std::string state_hash(const dynamics::State& state);

}  // namespace keyblock::simulation
