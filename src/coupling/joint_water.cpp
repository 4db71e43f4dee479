#include "coupling/joint_water.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/block_terms.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

const double* phi_at(const contact::Surface& surface, std::size_t vertex) {
  return &surface.phi[surface.phi_begin[vertex]];
}

/// What is remembered of an edge beside "it had no contact when the run began", which is 0.
constexpr double is_joint = 1.0, has_opened = 2.0;
/// Of an opening: rock stands in it.
constexpr double is_closed = -1.0;

/// Sine of the largest angle between two faces of a joint. A block that stands on the foot of a wall has a corner there, and no joint in its wall.
constexpr double most_sine = 0.3;

/// Per edge: it lies along an edge that it has a contact with.
std::vector<std::uint8_t> faced_edges(const contact::Surface& surface,
                                      const contact::CandidateList& contacts) {
  std::vector<std::uint8_t> faced(surface.block.size(), 0);
  const auto direction = [&](int edge) {
    return normalized(surface.position[at(surface.next[at(edge)])] - surface.position[at(edge)]);
  };
  for (const int k : contacts.tracked) {
    const contact::Candidate& c = contacts.pairs[at(k)];
    const Vec2 t = direction(c.edge);
    for (const int edge : {c.vertex, surface.previous[at(c.vertex)]}) {
      const Vec2 own = direction(edge);
      if (std::abs(cross(t, own)) <= most_sine && dot(t, own) < 0.0) faced[at(edge)] = faced[at(c.edge)] = 1;
    }
  }
  return faced;
}

}  // namespace

JointWater::JointWater(std::vector<Water> waters, std::vector<WaterFace> faces,
                       std::vector<WaterOpening> openings, std::vector<WateredBlock> blocks,
                       const contact::Surface& surface, const std::vector<Vec2>& reference)
    : waters_(std::move(waters)),
      faces_(std::move(faces)),
      openings_(std::move(openings)),
      blocks_(std::move(blocks)),
      edges_(surface.block.size()) {
  for (const Water& water : waters_) loads_.push_back(loads_of(water, surface, reference));
}

/// Pieces of a divided edge share the pressure as contacts share the joint, by Gauss and Lobatto's rule, where that is exact. Elsewhere each
/// piece is a chord of its own, with the exact resultant.
std::vector<JointWater::Load> JointWater::loads_of(const Water& water, const contact::Surface& surface,
                                                   const std::vector<Vec2>& reference) const {
  std::vector<Load> loads;
  // Whether the head is straight along all of the edge that a face is a piece of, and the face is all of the piece.
  const auto is_shared_by_rule = [&](const WaterFace& face) {
    if (surface.divided.empty() || face.from > 0.0 || face.to < 1.0) return false;
    const contact::DividedEdge& whole = surface.divided[at(face.vertex)];
    const int end = surface.next[at(whole.first + whole.pieces - 1)];
    return whole.pieces > 1 &&
           water.table.shares(reference[at(whole.first)], reference[at(end)], 0.0, 1.0).is_straight;
  };
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const WaterFace& face = faces_[f];
    const std::size_t v = at(face.vertex), next = at(surface.next[v]);
    if (water.dry[f] != 0) continue;
    loading::WaterTable::Shares shares =
        water.table.shares(reference[v], reference[next], face.from, face.to);
    if (is_shared_by_rule(face)) {
      shares.start = surface.start_share[v] * water.table.head(reference[v]);
      shares.end = (1.0 - surface.start_share[v]) * water.table.head(reference[next]);
    }
    if (shares.start > 0.0 || shares.end > 0.0)
      loads.push_back({f, water.weight * shares.start, water.weight * shares.end});
  }
  return loads;
}

JointWater::Wetness JointWater::wetness(const Model& model, const State& state,
                                        std::span<const double> memory) const {
  Wetness wet{.memory = memory, .filled = {}};
  for (std::size_t e = 0; e < openings_.size(); ++e) {
    const std::vector<int>& inside = openings_[e].inside;
    const bool is_open = !inside.empty() && std::ranges::none_of(inside, [&](int b) {
      return model.surface.present[at(b)] != 0;
    });
    const double released = state.walls.released.empty() ? 1.0 : state.walls.released[e];
    wet.filled.push_back(!is_open ? is_closed : openings_[e].is_filled ? released : 0.0);
  }
  wet.drains = model.water_drains && std::ranges::any_of(loads_[at(model.water)], [&](const Load& load) {
                 const WaterFace& face = faces_[load.face];
                 return face.excavation >= 0 && wet.filled[at(face.excavation)] == 0.0 &&
                        model.moves(at(model.surface.block[at(face.vertex)]));
               });
  return wet;
}

double JointWater::share_wet(const WaterFace& face, const Wetness& wet) {
  const bool is_wall = face.excavation >= 0 && wet.filled[at(face.excavation)] != is_closed;
  if (is_wall) return wet.filled[at(face.excavation)];
  const bool has_left = wet.drains && wet.remembered(face.vertex) == has_opened;
  return face.is_rock || has_left ? 0.0 : 1.0;
}

template <typename OfForce>
void JointWater::for_forces(const Model& model, const State& state, std::span<const double> memory,
                            const OfForce& of_force) const {
  if (model.water < 0) return;
  const contact::Surface& surface = model.surface;
  const Wetness wet = wetness(model, state, memory);
  for (const Load& load : loads_[at(model.water)]) {
    const WaterFace& face = faces_[load.face];
    const std::size_t v = at(face.vertex), b = at(surface.block[v]);
    if (!model.moves(b)) continue;
    const double share = share_wet(face, wet);
    if (share == 0.0) continue;
    const std::size_t next = at(surface.next[v]);
    // The block is on the left of its edge.
    const Vec2 inwards = share * perpendicular(surface.position[next] - surface.position[v]);
    of_force(face, b, v, load.at_start * inwards);
    of_force(face, b, next, load.at_end * inwards);
  }
}

void JointWater::add_terms(const Model& model, const State& state, const Drive& /*drive*/,
                           std::span<const double> memory, BlockTerms& terms) const {
  for_forces(model, state, memory, [&](const WaterFace&, std::size_t b, std::size_t v, Vec2 force) {
    terms.add_force(b, phi_at(model.surface, v), force);
  });
}

/// What is wet is remembered for the next step only now: contacts have accounted for themselves before, and the work is that of the forces
/// that the step was solved with.
CouplingTotals JointWater::account(const Attempt& attempt, std::span<const double> /*spin*/,
                                   std::size_t /*first*/, std::span<double> memory, State& state) const {
  const Model& model = attempt.model;
  double work = 0.0;
  for_forces(model, state, memory, [&](const WaterFace&, std::size_t b, std::size_t v, Vec2 force) {
    const Block& block = model.blocks[b];
    work += dot(force, field_at(phi_at(model.surface, v), block.size, &attempt.increment[block.first]));
  });
  state.ledger.water += work;
  remember_contacts(model, state, memory);
  return {};
}

void JointWater::remember_contacts(const Model& model, const State& state, std::span<double> memory) const {
  const std::vector<std::uint8_t> faced = faced_edges(model.surface, state.contacts);
  double& has_begun = memory[edges_];
  for (std::size_t v = 0; v < edges_; ++v) {
    const bool was_joint = memory[v] != 0.0, had_chance = has_begun != 0.0;
    if (was_joint || !had_chance) memory[v] = faced[v] != 0 ? is_joint : was_joint ? has_opened : 0.0;
  }
  has_begun = 1.0;
}

std::vector<double> JointWater::pressures(const Model& model, const State& state,
                                          std::span<const double> memory,
                                          std::span<const EdgePlace> places) const {
  std::vector<double> pressures(places.size(), 0.0);
  if (model.water < 0) return pressures;
  const Water& water = waters_[at(model.water)];
  const Wetness wet = wetness(model, state, memory);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& [edge, place] = places[k];
    const Vec2 from = model.reference[at(edge)],
               along = model.reference[at(model.surface.next[at(edge)])] - from;
    const double s = std::clamp(dot(place - from, along) / dot(along, along), 0.0, 1.0);
    for (auto face = std::ranges::lower_bound(faces_, edge, {}, &WaterFace::vertex);
         face != faces_.end() && face->vertex == edge; ++face) {
      if (s < face->from || s > face->to) continue;
      if (water.dry[static_cast<std::size_t>(face - faces_.begin())] == 0)
        pressures[k] = share_wet(*face, wet) * water.weight * water.table.head(place);
      break;
    }
  }
  return pressures;
}

std::vector<VertexForce> JointWater::wall_forces(const Model& model, const State& state,
                                                 std::span<const double> memory, int excavation) const {
  std::vector<VertexForce> forces;
  for_forces(model, state, memory, [&](const WaterFace& face, std::size_t /*b*/, std::size_t v, Vec2 force) {
    if (face.excavation == excavation) forces.push_back({static_cast<int>(v), force});
  });
  return forces;
}

/// N per thickness, per block; of all of them together where `block` is −1.
std::vector<Vec2> JointWater::forces_on_blocks(const Model& model, const State& state,
                                               std::span<const double> memory) const {
  std::vector<Vec2> forces(model.blocks.size());
  for_forces(model, state, memory,
             [&](const WaterFace&, std::size_t b, std::size_t /*v*/, Vec2 force) { forces[b] += force; });
  return forces;
}

Vec2 JointWater::force_on(const WateredBlock& block, const std::vector<Vec2>& of_block) {
  if (block.block >= 0) return of_block[at(block.block)];
  Vec2 sum;
  for (const Vec2 force : of_block) sum += force;
  return sum;
}

WaterTotals JointWater::totals(const Model& model, const State& state, std::span<const double> memory) const {
  WaterTotals totals;
  if (model.water < 0) return totals;
  const Water& water = waters_[at(model.water)];
  totals.acts = true;
  totals.name = water.name;
  const std::vector<Vec2> of_block = forces_on_blocks(model, state, memory);
  for (const WateredBlock& block : blocks_) totals.forces.emplace_back(block.name, force_on(block, of_block));
  const Wetness wet = wetness(model, state, memory);
  for (const Load& load : loads_[at(model.water)]) {
    const WaterFace& face = faces_[load.face];
    const std::size_t v = at(face.vertex), next = at(model.surface.next[v]);
    if (!model.moves(at(model.surface.block[v]))) continue;
    const Vec2 from = model.reference[v], to = model.reference[next];
    const double length = (face.to - face.from) * norm(to - from);
    if (share_wet(face, wet) == 0.0) {
      totals.drained += face.is_rock && face.excavation < 0 ? 0.0 : length;
      continue;
    }
    totals.wet += length;
    for (const double s : {face.from, face.to})
      totals.largest_pressure =
          std::max(totals.largest_pressure, water.weight * water.table.head(lerp(from, to, s)));
  }
  return totals;
}

std::vector<Element> JointWater::elements() const {
  std::vector<Element> all;
  for (const WateredBlock& block : blocks_)
    all.push_back({"water", block.name, HUGE_VAL, block.from_end, block.to_end});
  return all;
}

std::vector<Carried> JointWater::carried(const Model& model, const State& state,
                                         std::span<const double> memory) const {
  const contact::Surface& surface = model.surface;
  const std::vector<Vec2> of_block = forces_on_blocks(model, state, memory);
  std::vector<Carried> all;
  for (const WateredBlock& block : blocks_) {
    const Vec2 from = surface.position[at(block.from)], to = surface.position[at(block.to)];
    const Vec2 moved = 0.5 * (from - model.reference[at(block.from)] + to - model.reference[at(block.to)]);
    all.push_back({.from = from,
                   .to = to,
                   .force = norm(force_on(block, of_block)),
                   .elongation = norm(moved),
                   .present = block.block < 0 || surface.present[at(block.block)] != 0});
  }
  return all;
}

}  // namespace keyblock::dynamics
