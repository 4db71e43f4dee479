#include "simulation/damage.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/index.h"
#include "overlap/overlap.h"
#include "simulation/build_model.h"

namespace keyblock::simulation {

namespace {

Vec2 centroid_now(const dynamics::Block& block, const dynamics::State& state) {
  return Vec2{state.position[block.first], state.position[block.first + 1]} / std::sqrt(block.area);
}

// The block that holds a point, one of those beside it where the point is on a joint; −1 where there is none.
int moving_block_at(const dynamics::Model& model, Vec2 point) {
  const auto first = [&](bool (*holds)(const Polygon&, Vec2)) {
    for (std::size_t b = 0; b < model.blocks.size(); ++b) {
      if (model.moves(b) && holds(model.blocks[b].reference, point)) return static_cast<int>(b);
    }
    return -1;
  };
  const int inside = first(&contains);
  return inside >= 0 ? inside : first(&lies_in);
}

Box box_of(std::span<const Vec2> ring) {
  Box box;
  for (const Vec2 p : ring) box.add(p);
  return box;
}

}  // namespace

Polygon deformed_polygon(const dynamics::Model& model, std::size_t block) {
  const contact::Surface& surface = model.surface;
  Polygon polygon;
  int v = surface.block_begin[block];
  while (v < surface.block_begin[block + 1]) {
    Ring ring;
    const int first = v;
    do {
      ring.push_back(surface.position[at(v)]);
      ++v;
    } while (surface.next[at(v - 1)] != first);
    if (polygon.outer.empty()) {
      polygon.outer = std::move(ring);
    } else {
      polygon.holes.push_back(std::move(ring));
    }
  }
  return polygon;
}

void DamageGauge::start(const dynamics::State& state, std::span<const contact::Contact> contacts) {
  reference_.start.clear();
  std::vector<JointPiece>& pieces = reference_.pieces;
  pieces.clear();
  for (const dynamics::Block& block : model_.blocks) reference_.start.push_back(centroid_now(block, state));
  const auto is_frame = [&](int b) { return at(b) >= setup_.properties.size(); };
  for (const contact::Contact& c : contacts) {
    if (c.length <= 0.0 || is_frame(c.block_a) || is_frame(c.block_b)) continue;
    pieces.push_back({c.vertex, c.edge, c.position, c.length});
  }
  std::sort(pieces.begin(), pieces.end(), [](const JointPiece& x, const JointPiece& y) {
    return std::tie(x.vertex, x.edge) < std::tie(y.vertex, y.edge);
  });
  reference_.height = diameter(state, {0.0, 1.0});
  reference_.width = diameter(state, {1.0, 0.0});
}

DamageGauge::Offset DamageGauge::offset(const JointPiece& piece) const {
  const contact::Surface& surface = model_.surface;
  const Vec2 a = surface.position[at(piece.edge)], b = surface.position[at(surface.next[at(piece.edge)])];
  const Vec2 tangent = normalized(b - a),
             apart = surface.position[at(piece.vertex)] - lerp(a, b, piece.along);
  return {dot(tangent, apart), dot(Vec2{tangent.y, -tangent.x}, apart)};
}

double DamageGauge::slip(int vertex, int edge) const {
  const std::vector<JointPiece>& pieces = reference_.pieces;
  const auto piece = std::lower_bound(pieces.begin(), pieces.end(), std::pair{vertex, edge},
                                      [](const JointPiece& p, const auto& key) {
                                        return std::pair{p.vertex, p.edge} < key;
                                      });
  return piece != pieces.end() && piece->vertex == vertex && piece->edge == edge ? offset(*piece).slip : 0.0;
}

std::optional<double> DamageGauge::opening_width() const {
  if (setup_.excavations.empty()) return std::nullopt;
  return box_of(setup_.excavations.front().outline).size().x;
}

void DamageGauge::open(std::span<const int> excavations, const dynamics::State& state) {
  for (const int e : excavations) reference_.open[at(e)] = 1;
  for (Diameter* d : {&reference_.height, &reference_.width})
    d->closure = closure(*d, state);  // 0 before the start
  unite_openings();
}

void DamageGauge::restore(Reference reference) {
  reference_ = std::move(reference);
  unite_openings();
}

void DamageGauge::unite_openings() {
  std::vector<Polygon> outlines;
  for (std::size_t e = 0; e < setup_.excavations.size(); ++e) {
    if (reference_.open[e] != 0) outlines.push_back({setup_.excavations[e].outline, {}});
  }
  openings_ = overlap::union_of(outlines);
}

double DamageGauge::area_inside_openings(const Polygon& block) const {
  double sum = 0.0;
  for (const Polygon& opening : openings_) {
    if (!bounds(opening).overlaps(bounds(block))) continue;
    const Polygon pair[] = {block, opening};
    for (const overlap::Overlap& piece : overlap::all_overlaps(pair, 0.0)) sum += piece.area;
  }
  return sum;
}

std::vector<BlockStatus> DamageGauge::status(const dynamics::State& state) const {
  std::vector<BlockStatus> status(model_.blocks.size(), BlockStatus::in_place);
  const std::optional<double> width = opening_width();
  const double fall = setup_.damage.fall_distance.value_or(0.05 * width.value_or(0.0));
  const Vec2 down = model_.gravity == Vec2{} ? Vec2{0.0, -1.0} : normalized(model_.gravity);
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.surface.present[b]) status[b] = BlockStatus::excavated;
    if (!started() || !model_.moves(b)) continue;
    const dynamics::Block& block = model_.blocks[b];
    const Vec2 moved = centroid_now(block, state) - reference_.start[b];
    if (norm(moved) <= setup_.damage.loosened_distance) continue;
    status[b] = BlockStatus::loosened;
    if (fall <= 0.0 || norm(moved) <= fall) continue;
    if (dot(moved, down) > fall || area_inside_openings(deformed_polygon(model_, b)) > 0.5 * block.area)
      status[b] = BlockStatus::fallen;
  }
  return status;
}

Damage DamageGauge::measure(const dynamics::State& state) const {
  Damage damage;
  if (!started()) return damage;
  const std::vector<BlockStatus> status_now = status(state);
  double inside = 0.0, openings = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    if (status_now[b] == BlockStatus::fallen) {
      ++damage.fallen_blocks;
      damage.fallen_area += model_.blocks[b].area;
    }
    if (status_now[b] == BlockStatus::loosened) damage.loosened_area += model_.blocks[b].area;
    if (status_now[b] != BlockStatus::in_place) inside += area_inside_openings(deformed_polygon(model_, b));
  }
  for (const Polygon& opening : openings_) openings += area(opening);
  if (openings > 0.0) damage.opening_filled_ratio = inside / openings;

  double length = 0.0, slip_length = 0.0;
  for (const JointPiece& piece : reference_.pieces) {
    const std::size_t a = at(model_.surface.block[at(piece.vertex)]),
                      b = at(model_.surface.block[at(piece.edge)]);
    if (status_now[a] >= BlockStatus::fallen || status_now[b] >= BlockStatus::fallen) continue;
    const Offset now = offset(piece);
    const double slip = std::abs(now.slip);
    damage.slip_max = std::max(damage.slip_max, slip);
    slip_length += slip * piece.length;
    length += piece.length;
    if (slip > setup_.damage.slip) damage.slipped_length += piece.length;
    if (now.opening > setup_.damage.opening) damage.opened_length += piece.length;
  }
  damage.slip_mean = length > 0.0 ? slip_length / length : 0.0;
  damage.closure_vertical = closure(reference_.height, state);
  damage.closure_horizontal = closure(reference_.width, state);
  return damage;
}

DamageGauge::Diameter DamageGauge::diameter(const dynamics::State& state, Vec2 direction) const {
  Diameter d;
  if (setup_.excavations.empty()) return d;
  const Ring& outline = setup_.excavations.front().outline;
  const Vec2 centre = centroid({outline, {}});
  for (int end = 0; end < 2; ++end) {
    const Vec2 out = end == 0 ? direction : -direction;
    // Where a ray from the centre leaves the outline, and a little beyond: in the wall. A corner on the ray is an end of one of the
    // two edges that meet there, never of none.
    double reach = 0.0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k] - centre, b = outline[(k + 1) % outline.size()] - centre;
      if ((cross(out, a) >= 0.0) == (cross(out, b) >= 0.0)) continue;
      const Vec2 along = b - a;
      const double denominator = cross(out, along);
      if (denominator != 0.0) reach = std::max(reach, cross(a, along) / denominator);
    }
    d.ends[end] = centre + 1.001 * reach * out;
    d.blocks[end] = moving_block_at(model_, d.ends[end]);
  }
  d.length = length(d, state).value_or(0.0);
  return d;
}

std::optional<double> DamageGauge::length(const Diameter& d, const dynamics::State& state) const {
  Vec2 now[2];
  for (int end = 0; end < 2; ++end) {
    if (d.blocks[end] < 0) return std::nullopt;
    const std::size_t b = at(d.blocks[end]);
    if (!model_.moves(b)) return std::nullopt;
    const dynamics::Block& block = model_.blocks[b];
    std::vector<double> phi(at(block.size));
    block.basis.evaluate(d.ends[end], phi.data());
    for (std::size_t k = 0; k < phi.size(); ++k)
      now[end] += phi[k] * Vec2{state.position[block.first + 2 * k], state.position[block.first + 2 * k + 1]};
  }
  return norm(now[0] - now[1]);
}

double DamageGauge::closure(const Diameter& d, const dynamics::State& state) const {
  const std::optional<double> now = length(d, state);
  return now ? d.length - *now : d.closure;
}

}  // namespace keyblock::simulation
