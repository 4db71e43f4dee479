#pragma once
#include <string>
#include <vector>

#include "picture/marks.h"
#include "picture/picture.h"
#include "picture/quantities.h"
#include "picture/view.h"
#include "results/joint_pieces.h"

/// What lies over each other in a picture of a section, each layer by a function of its own.
namespace keyblock::picture {

/// What a layer stands on.
struct Canvas {
  const results::RunData& run;
  const View& view;
  const Placement& place;
  double block_size;  ///< m: side of a mean block
};

std::string draw_fixed(const Canvas& canvas);
std::string draw_blocks(const Canvas& canvas, const BlockValues& values, const std::vector<double>& now);
/// Outlines of excavations as they were planned.
std::string draw_excavations(const Canvas& canvas);
/// Blocks as they were before anything moved.
std::string draw_before(const Canvas& canvas);

std::string draw_joint_sets(const Canvas& canvas);
std::string draw_states(const Canvas& canvas, const std::vector<results::JointPiece>& pieces);
/// Joints that have slipped or opened, the wider and darker the more.
std::string draw_sizes(const Canvas& canvas, const std::vector<results::JointPiece>& pieces, bool slips,
                       const Scale& scale);
/// Named colours of the last two.
std::vector<NamedColor> state_colors();
std::vector<NamedColor> set_colors(const record::ModelRecord& model);

/// Springs, supports and other elements: the wider and darker the more of its limit each carries; of those without, of the largest of its kind.
std::string draw_elements(const Canvas& canvas, double largest_free);

std::string draw_forces(const Canvas& canvas, const record::ContactFrame& contacts, double typical);
std::string draw_thrust(const Canvas& canvas, const record::ContactFrame& contacts, double typical);
std::string draw_crosses(const Canvas& canvas, double typical);
std::string draw_arrows(const Canvas& canvas, const std::vector<Vec2>& vectors, double typical);

}  // namespace keyblock::picture
