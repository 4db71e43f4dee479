#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace keyblock::record {

enum class StageKind {
  settle,  ///< static: pseudo-time steps without velocity until every block is in equilibrium
  shake,   ///< dynamic under a ground motion
  rest,    ///< dynamic without one
};

/// Most steps of a settling stage that gives no `max_steps`.
constexpr int default_settle_steps = 3000;

struct Stage {
  std::string name;
  StageKind kind = StageKind::settle;
  std::vector<int> excavate;         ///< excavations opened at the start, by index
  std::vector<std::string> install;  ///< supports that come to life at the start, after that, by name
  /// settle: excavations opened in parts, with the share of the forces of their rock that acts no more at the end of the stage.
  std::vector<std::pair<int, double>> release;
  int release_steps = 10;  ///< parts in which it is released
  int motion = -1;         ///< shake: index of the ground motion
  double scale = 1.0;      ///< shake: factor on the accelerations
  std::optional<double>
      duration;              ///< s; shake: default the motion's; the longest, where it ends when all is still
  bool until_still = false;  ///< shake, rest: it ends once nothing moves any more (Stillness)
  double still_time = 0.5;   ///< s, for so long
  std::optional<double> still_distance;  ///< m, by more than this; default a twentieth of DamageLimits::slip
  /// m/s²; a motion that stays below it, or below a twentieth of its peak, is over
  double still_acceleration = 0.05;
  std::optional<int> max_steps;  ///< settle
  /// settle: inertia forces of an earthquake as loads that stay, over the weight: to the right, and up.
  double k_h = 0.0, k_v = 0.0;
  /// What strength of joints is divided by while the stage lasts, but that of the frame; of which sets, maps or `joints`, by name: of all.
  double strength_factor = 1.0;
  std::vector<std::string> strength_of;
  std::optional<int>
      water;  ///< of RunSetup::waters, from this stage on; −1: none. Not given: as before (water_in)
  /// Whether slip counts for the strength of joints. Not given: in every stage but those that turn gravity on (wears_joints).
  std::optional<bool> wears_joints;
  double tolerance = 1e-4;  ///< settle: largest residual of a block over its weight at equilibrium
};

/// Whether slip of stage k wears joints (contact::JointLaw::residual). What turns gravity on shall not use strength up: static stages without
/// an excavation, a load of an earthquake or anything installed do not count, as long as nothing else came before them and a stage comes after.
bool wears_joints(std::span<const Stage> stages, std::size_t k);

}  // namespace keyblock::record
