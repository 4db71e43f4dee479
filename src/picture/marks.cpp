#include "picture/marks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "picture/force_chains.h"
#include "picture/quantities.h"

namespace keyblock::picture {
namespace {

constexpr Mark marks_in_order[] = {
    {"forces", "force chains",
     "normal forces between blocks: lines through the contacts, as wide as the force", Quantity::force, 4.0,
     "#1d1f22"},
    {"stress", "principal stresses",
     "a cross per block: principal stresses, compression and tension in two colours", Quantity::stress, 1.2,
     "#0b3c8c"},
    {"displacement", "displacement vectors", "an arrow per block: its displacement", Quantity::length, 2.0,
     "#a0187a"},
    {"velocity", "velocity vectors", "an arrow per block: its velocity", Quantity::velocity, 2.0, "#a0187a"},
    {"outline", "outline before", "the blocks as they were, over those as they are", Quantity::none, 0.0,
     "#0072b2"},
    {"thrust", "line of thrust, hinges",
     "the line of thrust of arches and columns; a dot is a hinge: the force is at the end of the joint",
     Quantity::force, 0.0, "#c2185b"},
};
constexpr double usual_share = 0.95;

double usual(std::vector<double>& values) {
  std::erase_if(values, [](double v) { return !(v > 0.0) || !std::isfinite(v); });
  const double found = quantile(values, usual_share);
  return found > 0.0 ? found : 1.0;
}

void add_arrows(const results::RunData& run, std::size_t f, std::vector<double>& ways,
                std::vector<double>& speeds) {
  const record::Frame& frame = run.frames[f];
  const std::vector<Vec2> displacements = block_displacements(run, f);
  for (std::size_t b = 0; b < displacements.size(); ++b) {
    // What has fallen has gone farther than any arrow could show.
    const bool counts = !run.model.blocks[b].fixed && frame.status[b] != record::BlockStatus::excavated &&
                        frame.status[b] != record::BlockStatus::fallen;
    if (!counts) continue;
    ways.push_back(norm(displacements[b]));
    if (!frame.velocity.empty()) speeds.push_back(std::hypot(frame.velocity[b][0], frame.velocity[b][1]));
  }
}

}  // namespace

std::span<const Mark> all_marks() {
  return marks_in_order;
}

const Mark& mark_of(std::string_view name) {
  for (const Mark& mark : marks_in_order)
    if (mark.name == name) return mark;
  throw std::invalid_argument("no mark " + std::string(name));
}

double Typical::of(std::string_view mark) const {
  if (mark == "stress") return stress;
  if (mark == "displacement") return displacement;
  return mark == "velocity" ? velocity : force;
}

Typical typical_sizes(const results::RunData& run) {
  std::vector<double> forces, stresses, ways, speeds;
  for (const std::size_t f : stage_end_frames(run)) {
    if (const auto* contacts = contacts_at(run, f); contacts != nullptr)
      for (const ForceChain& chain : force_chains(*contacts)) forces.push_back(chain.force);
    const record::Frame& frame = run.frames[f];
    for (std::size_t b = 0; b < run.model.blocks.size(); ++b) {
      if (run.model.blocks[b].fixed || frame.status[b] == record::BlockStatus::excavated) continue;
      const Principal p = principal_of(frame.stress[b]);
      stresses.push_back(std::max(std::abs(p.larger), std::abs(p.smaller)));
    }
  }
  constexpr std::size_t samples = 12;
  for (std::size_t k = 0; k < samples && !run.frames.empty(); ++k)
    add_arrows(run, k * (run.frames.size() - 1) / (samples - 1), ways, speeds);
  return {usual(forces), usual(stresses), usual(ways), usual(speeds)};
}

}  // namespace keyblock::picture
