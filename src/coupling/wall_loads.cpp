#include "coupling/wall_loads.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/block_terms.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

const double* phi_at(const contact::Surface& surface, std::size_t vertex) {
  return &surface.phi[surface.phi_begin[vertex]];
}

/// N per thickness, of a pressure on a face as it lies.
Vec2 force_on(const contact::Surface& surface, const WallFace& face, double pressure) {
  const std::size_t v = at(face.vertex), next = at(surface.next[v]);
  const Vec2 along = (face.to - face.from) * (surface.position[next] - surface.position[v]);
  // As it lies: a wall that turns takes its support along, as a lining does.
  return pressure * perpendicular(along);  // the block is on the left of its edge
}

/// Share that the start of its edge has of a pressure on a face. Of a whole piece of a divided edge it is that of Gauss and Lobatto's rule.
double start_share(const contact::Surface& surface, const WallFace& face) {
  const bool is_whole = face.from == 0.0 && face.to == 1.0;
  if (is_whole && !surface.start_share.empty()) return surface.start_share[at(face.vertex)];
  return 1.0 - 0.5 * (face.from + face.to);
}

}  // namespace

template <typename OfForce>
void WallLoads::for_forces(const Model& model, const State& state, double time,
                           const OfForce& of_force) const {
  const contact::Surface& surface = model.surface;
  const WallState& walls = state.walls;
  const auto feels = [&](std::size_t b) { return model.moves(b) && walls.left[b] == 0; };
  for (const WallForce& wall : walls.forces) {
    const std::size_t v = at(wall.vertex), b = at(surface.block[v]);
    const double kept = 1.0 - walls.released[at(wall.excavation)];
    // A block that has left the wall is pressed no more: what was cut away from it does not follow it down.
    if (kept > 0.0 && feels(b)) of_force(b, v, kept * wall.force);
  }
  for (const WallPressure& wall : pressures_) {
    const double pressure = pressure_of(wall, walls, time);
    if (pressure == 0.0) continue;
    for (const WallFace& face : wall.faces) {
      const std::size_t v = at(face.vertex), next = at(surface.next[v]), b = at(surface.block[v]);
      if (!feels(b)) continue;
      const Vec2 force = force_on(surface, face, pressure);
      const double share = start_share(surface, face);
      of_force(b, v, share * force);
      of_force(b, next, (1.0 - share) * force);
    }
  }
}

void WallLoads::add_terms(const Model& model, const State& state, const Drive& drive,
                          std::span<const double> /*memory*/, BlockTerms& terms) const {
  for_forces(model, state, drive.end_time, [&](std::size_t b, std::size_t v, Vec2 force) {
    terms.add_force(b, phi_at(model.surface, v), force);
  });
}

void WallLoads::add_weights(const Model& model, const State& state, const Drive& drive,
                            std::span<double> weight) const {
  for_forces(model, state, drive.end_time, [&](std::size_t b, std::size_t /*v*/, Vec2 force) {
    weight[b] = std::max(weight[b], norm(force) / std::sqrt(model.blocks[b].area));
  });
}

CouplingTotals WallLoads::account(const Attempt& attempt, std::span<const double> /*spin*/,
                                  std::size_t /*first*/, std::span<double> /*memory*/, State& state) const {
  const Model& model = attempt.model;
  const Drive& drive = attempt.drive;
  double work = 0.0, earlier = 0.0;
  const auto work_of = [&](std::size_t b, std::size_t v, Vec2 force) {
    const Block& block = model.blocks[b];
    return dot(force, field_at(phi_at(model.surface, v), block.size, &attempt.increment[block.first]));
  };
  const auto of_start = [&](std::size_t b) { return 1.0 - drive.end_share_of_work(static_cast<int>(b)); };
  for_forces(model, state, drive.end_time, [&](std::size_t b, std::size_t v, Vec2 force) {
    const double done = work_of(b, v, force);
    work += done;
    earlier -= of_start(b) * done;
  });
  for_forces(model, state, drive.start_time(), [&](std::size_t b, std::size_t v, Vec2 force) {
    earlier += of_start(b) * work_of(b, v, force);
  });
  state.ledger.input += work + earlier;
  state.ledger.numerical += earlier;
  return {};
}

std::vector<Element> WallLoads::elements() const {
  std::vector<Element> all;
  for (const WallStretch& stretch : stretches_)
    all.push_back({"pressure", stretch.name, HUGE_VAL, stretch.from_end, stretch.to_end});
  return all;
}

std::vector<Carried> WallLoads::carried(const Model& model, const State& state,
                                        std::span<const double> /*memory*/) const {
  const contact::Surface& surface = model.surface;
  const auto lies = [&](std::span<const Vec2> places, std::size_t v, double share) {
    return lerp(places[v], places[at(surface.next[v])], share);
  };
  std::vector<Carried> all(stretches_.size());
  std::vector<Vec2> force(stretches_.size()), moved(stretches_.size());
  std::vector<double> length(stretches_.size());
  for (const WallPressure& wall : pressures_) {
    const double pressure = pressure_of(wall, state.walls, state.time);
    if (pressure == 0.0) continue;
    for (std::size_t f = 0; f < wall.faces.size(); ++f) {
      const WallFace& face = wall.faces[f];
      const std::size_t v = at(face.vertex), b = at(surface.block[v]), e = wall.element[f];
      if (!model.moves(b) || state.walls.left[b] != 0) continue;
      const double middle = 0.5 * (face.from + face.to),
                   share = (face.to - face.from) *
                           norm(model.reference[at(surface.next[v])] - model.reference[v]);
      force[e] += force_on(surface, face, pressure);
      moved[e] += share * (lies(surface.position, v, middle) - lies(model.reference, v, middle));
      length[e] += share;
    }
  }
  for (std::size_t e = 0; e < stretches_.size(); ++e) {
    const WallPoint &from = stretches_[e].from, &to = stretches_[e].to;
    all[e] = {.from = lies(surface.position, at(from.vertex), from.share),
              .to = lies(surface.position, at(to.vertex), to.share),
              .force = norm(force[e]),
              .elongation = length[e] > 0.0 ? norm(moved[e]) / length[e] : 0.0,
              .present = length[e] > 0.0};
  }
  return all;
}

}  // namespace keyblock::dynamics
