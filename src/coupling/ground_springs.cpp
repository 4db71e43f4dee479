#include "coupling/ground_springs.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/block_terms.h"
#include "model/turn.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

/// Σ φ_k c_k along the axis of a spring, of coefficients by Block::first.
double along_axis(const Model& model, const GroundSpring& spring, std::span<const double> coefficients) {
  const std::size_t first = model.blocks[at(spring.block)].first + at(spring.axis);
  double sum = 0.0;
  for (std::size_t k = 0; k < spring.phi.size(); ++k) sum += spring.phi[k] * coefficients[first + 2 * k];
  return sum;
}

}  // namespace

void GroundSprings::add_terms(const Model& model, const State& state, const Drive& drive,
                              std::span<const double> /*memory*/, BlockTerms& terms) const {
  for (const GroundSpring& spring : springs_) {
    if (!model.moves(at(spring.block))) continue;
    const double stretch = along_axis(model, spring, state.position) - spring.target(drive.end_time);
    terms.add_spring(at(spring.block), spring.axis, spring.phi, spring.stiffness,
                     -spring.stiffness * stretch);
  }
}

CouplingTotals GroundSprings::account(const Attempt& attempt, std::span<const double> spin,
                                      std::size_t /*first*/, std::span<double> /*memory*/,
                                      State& state) const {
  const Model& model = attempt.model;
  const Drive& drive = attempt.drive;
  for (const GroundSpring& spring : springs_) {
    const std::size_t b = at(spring.block);
    if (!model.moves(b)) continue;
    const double moved = along_axis(model, spring, attempt.increment),
                 before = spring.target(drive.start_time()), end = spring.target(drive.end_time);
    const double stretch = along_axis(model, spring, state.position) + moved - end,
                 change = moved - (end - before);
    state.support_energy += 0.5 * spring.stiffness * stretch * stretch;
    // With the force at the start the spring was shorter by `change`.
    const double earlier =
        (1.0 - drive.end_share_of_work(spring.block)) * spring.stiffness * change * (end - before);
    state.ledger.input -= spring.stiffness * stretch * (end - before) - earlier;
    state.ledger.numerical += earlier;
    // BlockTerms::elastic_loss has taken ½ k moved² for a ground that stands still, and what the pose update takes out of D: the spring is
    // linear in D.
    const double* position = &state.position[model.blocks[b].first];
    double turned = 0.0;
    for (std::size_t k = 0; k < spring.phi.size(); ++k)
      turned += spring.phi[k] * turn_of(spin[b], position, 2 * k + at(spring.axis));
    state.ledger.numerical +=
        spring.stiffness * (0.5 * (change * change - moved * moved) - (moved - 0.5 * turned) * turned);
  }
  return {};
}

double GroundSprings::stored_energy(const Model& model, const State& state, double time,
                                    std::span<const double> /*memory*/) const {
  double sum = 0.0;
  for (const GroundSpring& spring : springs_) {
    if (!model.moves(at(spring.block))) continue;
    const double stretch = along_axis(model, spring, state.position) - spring.target(time);
    sum += 0.5 * spring.stiffness * stretch * stretch;
  }
  return sum;
}

std::vector<Element> GroundSprings::elements() const {
  std::vector<Element> all;
  for (const SupportedPlace& place : places_)
    all.push_back(
        {"support", place.name, HUGE_VAL, {place.from_place, place.block}, {place.to_place, place.block}});
  return all;
}

std::vector<Carried> GroundSprings::carried(const Model& model, const State& state,
                                            std::span<const double> /*memory*/) const {
  std::vector<Carried> all(places_.size());
  std::vector<Vec2> force(places_.size()), stiffness(places_.size());
  for (const GroundSpring& spring : springs_) {
    if (!model.moves(at(spring.block))) continue;
    const double stretch = along_axis(model, spring, state.position) - spring.target(state.time);
    (spring.axis == 0 ? force[spring.support].x : force[spring.support].y) += spring.stiffness * stretch;
    (spring.axis == 0 ? stiffness[spring.support].x : stiffness[spring.support].y) += spring.stiffness;
  }
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Block& block = model.blocks[at(places_[k].block)];
    const auto position = [&](const std::vector<double>& phi) {
      return field_at(phi.data(), block.size, &state.position[block.first]);
    };
    const auto way = [](double f, double s) { return s > 0.0 ? f / s : 0.0; };
    all[k] = {.from = position(places_[k].from),
              .to = position(places_[k].to),
              .force = norm(force[k]),
              .elongation = norm(Vec2{way(force[k].x, stiffness[k].x), way(force[k].y, stiffness[k].y)}),
              .present = model.moves(at(places_[k].block))};
  }
  return all;
}

void GroundSprings::add_held_blocks(std::vector<int>& blocks) const {
  for (const GroundSpring& spring : springs_) blocks.push_back(spring.block);
}

void GroundSprings::add_rounding_forces(const Model& model, double extent, std::span<double> force) const {
  for (const GroundSpring& spring : springs_) {
    double largest = 0.0;
    for (const double phi : spring.phi) largest = std::max(largest, std::abs(phi));
    force[at(spring.block)] +=
        spring.stiffness * extent * largest * std::sqrt(model.blocks[at(spring.block)].area);
  }
}

}  // namespace keyblock::dynamics
