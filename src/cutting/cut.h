#pragma once
#include <optional>
#include <vector>

#include "cutting/block_system.h"
#include "cutting/joint_strengths.h"
#include "rockmass/trace.h"

namespace keyblock::cutting {

/// The tolerances of cutting. Defaults scale with √(domain area) = L; in brackets their values for a domain
/// of 20 × 20 m. Zero switches a step off.
struct CutTolerances {
  /// m. L, where slivers and close vertices are judged against the blocks around them: tolerances that are not given are lower
  /// where these are small (local_size.h). 0: all are as they stand here.
  double size = 0.0;
  bool sliver_area_is_given = false, sliver_thickness_is_given = false, cluster_is_given = false;

  /// m. A trace that ends closer than this to another line is made to end on it. Usual: the accuracy of the
  /// map, or 5e-5 L [1 mm]. Too small: joints that a digitiser meant to meet bound no block; too large:
  /// rock bridges disappear.
  double snapping = 0.0;
  /// m². Blocks of less area are merged. Usual: 2.5e-6 L² [1e-3 m²]. Too small: blocks of grams beside blocks
  /// of tons, which cost solver iterations; too large: real key blocks disappear.
  double sliver_area = 0.0;
  /// m. Blocks of less area over perimeter are merged (a long strip of width w has w/2, a square of side w has
  /// w/4). Usual: 2.5e-4 L [5 mm]. Must exceed a few times the depth at which a contact is looked for.
  double sliver_thickness = 0.0;
  /// m. Vertices closer than this become one, and an edge that passes a vertex within a fifth of it is bent to
  /// go through it. Usual: 2.5e-4 L [5 mm]. Too small: edges shorter than the end zones of contacts, tongues
  /// thinner than a penetration; too large: shapes and angles change.
  double cluster = 0.0;
  /// m. A vertex nearer than this to the straight line between its neighbours is dropped, by the blocks on both sides.
  /// Where joints meet, a block drops one only within the default, as the others keep it: the foot of a T. Usual:
  /// 5e-8 L [1 µm]. Larger: curved joints and outlines of fewer edges; shapes change by as much.
  double collinear = 0.0;

  /// None is given. L is the square root of the area of the domain (m²), at most 80 times the area over the length of all traces in it (m):
  /// the size of blocks, not only that of the model, says what is small.
  static CutTolerances for_domain(double domain_area, double trace_length = 0.0);
  /// None is given, and L is known (m).
  static CutTolerances for_size(double size);
};

/// Where rock bridges are cut along with the joints, as joints of their own.
struct BridgeInput {
  EdgeLabel label;                         ///< of kind joint_set, after all sets
  std::vector<rockmass::Trace> in_gaps{};  ///< between two traces on one line; source: of these
  bool at_dead_ends = false;               ///< traces that end in rock go on to the next line as bridges
};

/// What is cut. Real coordinates; rings in either sense.
struct CutInput {
  Ring domain;
  std::vector<rockmass::Trace> traces;
  std::vector<Ring> excavations;            ///< outlines, by index of the excavation
  std::optional<CutTolerances> tolerances;  ///< default: CutTolerances::for_domain
  JointStrengths strengths{};               ///< default: all joints are alike
  std::optional<BridgeInput> bridges{};     ///< none: what ends in rock bounds no block
};

/// Cuts the domain by traces and excavation outlines into blocks.
///
/// 1. Ends of traces within `snapping` of another line are put on it; everything is rounded to a grid of about
///    L·2⁻⁴⁴ and noded there by snap rounding (GEOS): lines meet in common vertices only.
///    Rock bridges are lines like others, those from dead ends (bridges.h) found before the last noding.
/// 2. Dead ends and joints that bound no block are removed (tree cutting): after that the two sides of every edge
///    are different blocks. A ring of joints within a block makes a hole in it and a block of its own.
/// 3. Cleaning: slivers are merged into a neighbour, smallest first, never across an excavation outline, and not across a weak plane
///    or a joint that runs through if there is another way (cleaning.h); vertices closer than `cluster` become one for all blocks at them, and edges take in
///    the vertices they nearly touch, where that turns no block over; slivers are merged again; near-collinear
///    vertices are dropped, the foot of a T from the straight side only.
///
/// Where lines overlap, the edge is labelled domain before excavation before trace map before joint set, the
/// lower index first. Every block lies wholly inside or outside of every excavation outline.
/// Blocks are sorted by the y, then the x of their centroids, rings begin at their lowest (then leftmost) vertex.
///
/// Throws InputError when the domain or an outline is no simple polygon, RunError when the result does not fill the
/// domain (1e-9 of its area) or a block crosses itself; the message names the place.
BlockSystem cut(const CutInput& input);

}  // namespace keyblock::cutting
