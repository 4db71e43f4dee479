#pragma once
#include <string>
#include <vector>

#include "cutting/block_system.h"
#include "rockmass/random_strength.h"
#include "rockmass/trace.h"
#include "scenario/scenario.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// The joints and blocks of one realization.
struct BlockModel {
  std::vector<rockmass::Trace> traces;  ///< generated and mapped, real coordinates
  int realization = 0;
  /// Strengths that trace maps have of their own, by map and number of the trace; empty for maps without.
  std::vector<std::vector<rockmass::TraceStrength>> map_strengths;
  std::vector<std::string> skipped;  ///< what is no line of the drawings of trace maps, in words
  std::vector<Ring> outlines;        ///< of the excavations, counter-clockwise, real coordinates
  /// The blocks cut from the domain, then those of the scenario with edges of kind `free`; an explicit block belongs
  /// to the excavations whose outline it lies in (excavated_blocks.h). Local coordinates. Without a domain the local origin is a
  /// rounded corner of the blocks if they lie far away.
  cutting::BlockSystem system;
};

/// Generates traces, reads trace maps and cuts the domain. Needs neither stages nor motions. Throws InputError.
BlockModel build_blocks(const Scenario& scenario, int realization);

/// What seems wrong with the cutting of a scenario that can be cut, added to `warnings`: excavations that hold no block or
/// every block, trace maps outside the domain.
void add_block_warnings(const Scenario& scenario, const BlockModel& model,
                        std::vector<std::string>& warnings);

/// Explicit blocks that overlap at the start: each other, blocks of the domain, or the frame around it.
void add_overlap_warnings(const Scenario& scenario, const cutting::BlockSystem& system,
                          std::vector<std::string>& warnings);

/// Everything a run needs, except for `version`. Of a block's keys those of its [[block]] go before those of the last
/// [[region]] that holds its centroid, and those before [rock].
///
/// In-situ stress from depth h and K0, with y_top the top of the domain (without one, of the blocks):
///     σ_yy = −ρ g (h + y_top − y),   σ_xx = K0 σ_yy.
///
/// `warnings`, if given, receives what plausibility_warnings and read_motions have to say, and what shows only when
/// blocks are cut. Throws InputError for mistakes in files, no stages, stages of less than one step or too many, points
/// outside all blocks, and a model with an absurd number of unknowns; RunError when cutting fails.
simulation::RunSetup build_setup(const Scenario& scenario, int realization,
                                 std::vector<std::string>* warnings = nullptr);

/// The same from blocks that are there already.
simulation::RunSetup build_setup(const Scenario& scenario, int realization, const BlockModel& blocks,
                                 std::vector<std::string>* warnings = nullptr);

}  // namespace keyblock::scenario
