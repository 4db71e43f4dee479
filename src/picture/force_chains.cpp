#include "picture/force_chains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/index.h"

namespace keyblock::picture {
namespace {

// Sums over the contacts of two blocks. Contacts that are open say how far the joint goes.
struct JointOfPair {
  double force = 0.0;
  Vec2 moment, along;
  double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();

  void add(const record::ContactRecord& c) {
    if (norm(along) == 0.0) along = perpendicular(c.normal);
    const double place = dot(c.position, along);
    from = std::min(from, place);
    to = std::max(to, place);
    if (!(c.normal_force > 0.0)) return;
    force += c.normal_force;
    moment += c.normal_force * c.position;
  }
};

}  // namespace

bool ForceChain::is_hinge() const {
  constexpr double near_the_end = 0.9;
  return std::abs(eccentricity) > near_the_end;
}

std::vector<ForceChain> force_chains(const record::ContactFrame& contacts) {
  std::map<std::pair<int, int>, JointOfPair> joints;
  for (const record::ContactRecord& c : contacts.contacts) joints[std::minmax(c.block_a, c.block_b)].add(c);
  std::vector<ForceChain> chains;
  for (const auto& [blocks, joint] : joints) {
    if (!(joint.force > 0.0)) continue;
    ForceChain chain{blocks.first, blocks.second, joint.force, joint.moment / joint.force, 0.0};
    const double half = 0.5 * (joint.to - joint.from);
    if (half > 0.0)
      chain.eccentricity = (dot(chain.middle, joint.along) - 0.5 * (joint.from + joint.to)) / half;
    chains.push_back(chain);
  }
  return chains;
}

std::vector<Thrust> lines_of_thrust(const record::ModelRecord& model, const std::vector<ForceChain>& chains) {
  std::vector<std::vector<const ForceChain*>> of_block(model.blocks.size());
  for (const ForceChain& chain : chains)
    for (const int b : {chain.block_a, chain.block_b}) of_block[at(b)].push_back(&chain);
  std::vector<Thrust> lines;
  for (std::size_t b = 0; b < of_block.size(); ++b) {
    const auto& pressed = of_block[b];
    if (model.blocks[b].fixed || pressed.size() != 2) continue;
    lines.push_back({static_cast<int>(b), pressed[0]->middle, pressed[1]->middle,
                     std::max(pressed[0]->force, pressed[1]->force)});
  }
  return lines;
}

}  // namespace keyblock::picture
