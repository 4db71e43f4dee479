#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "contact/candidates.h"
#include "geometry/vec2.h"

namespace keyblock::dynamics {

/// Sums over the run, J per thickness.
struct EnergyLedger {
  double friction = 0.0;   ///< dissipated by slip, and by springs that yield
  double damping = 0.0;    ///< dissipated by the dashpots of contacts and the viscosity of the rock
  double input = 0.0;      ///< done by ground motion, loads and moved supports
  double numerical = 0.0;  ///< dissipated by the time integration
  double radiated = 0.0;   ///< carried away by waves through the boundary
  double water = 0.0;      ///< done by the pressure of water
};

/// What rock that is excavated did to a vertex of the wall that it leaves.
struct WallForce {
  Vec2 force;          ///< N per thickness
  int vertex = 0;      ///< of the surface
  int excavation = 0;  ///< that the rock was in
};

/// What acts on the walls of openings (WallLoads); all empty where nothing can.
struct WallState {
  std::vector<WallForce> forces;
  std::vector<double> released;    ///< per excavation: share of its forces that acts no more
  std::vector<double> pressure;    ///< Pa, per excavation: support pressure of the stage
  std::vector<std::uint8_t> left;  ///< per block: it has left the wall, and nothing acts on it any more
};

/// Everything that changes from step to step, and all that a restart needs.
struct State {
  double time = 0.0;  ///< s; static steps count none
  long step = 0;
  double last_step =
      0.0;  ///< s, length of the last dynamic step, which may be one of several halves; 0: none
  std::vector<double> position;  ///< coefficients a, by Body::first
  std::vector<double> velocity;
  /// Acceleration and sum of forces over mass of every coefficient at the end of the last step, for rules that need them;
  /// valid for blocks whose last step left them known.
  std::vector<double> acceleration, force;
  std::vector<std::uint8_t> acceleration_known;  ///< per body
  std::vector<double> moved;  ///< m, per block: largest displacement of a vertex in the last step
  contact::CandidateList contacts;
  std::vector<std::pair<int, int>> pattern;  ///< pairs of blocks that the matrix has room for
  EnergyLedger ledger;
  std::vector<std::vector<double>> couplings;  ///< what each of Model::couplings remembers
  WallState walls;
  std::vector<std::uint8_t> installed;  ///< per support that a stage installs: it is there
  /// J per thickness, stored in the springs of contacts and of other couplings, as the last step summed it.
  double contact_energy = 0.0, support_energy = 0.0;
};

}  // namespace keyblock::dynamics
