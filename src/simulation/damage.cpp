#include "simulation/damage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/index.h"
#include "record/fallen.h"
#include "record/standing.h"

namespace keyblock::simulation {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Vec2 centroid_now(const dynamics::Block& block, const dynamics::State& state) {
  return Vec2{state.position[block.first], state.position[block.first + 1]} / std::sqrt(block.area);
}

/// Of a unit of √(area of a block): what it moves by before it counts as fallen, where there is no opening to fall into.
constexpr double fall_share = 0.5;

// rad, by which a block has turned against its reference position, of all that turn it the one that fits its corners best.
double turn_of(const dynamics::Model& model, std::size_t block) {
  const contact::Surface& surface = model.surface;
  const std::size_t begin = at(surface.block_begin[block]), end = at(surface.block_begin[block + 1]);
  Vec2 before, now;
  for (std::size_t v = begin; v < end; ++v) {
    before += model.reference[v] / static_cast<double>(end - begin);
    now += surface.position[v] / static_cast<double>(end - begin);
  }
  double along = 0.0, across = 0.0;
  for (std::size_t v = begin; v < end; ++v) {
    along += dot(model.reference[v] - before, surface.position[v] - now);
    across += cross(model.reference[v] - before, surface.position[v] - now);
  }
  return std::atan2(across, along);
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
  reference_.base.clear();
  for (const dynamics::Block& block : model_.blocks) {
    reference_.start.push_back(centroid_now(block, state));
    reference_.base.push_back(base_.displacement(state, block.centroid));
  }
  reference_.turn.clear();
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) reference_.turn.push_back(turn_of(model_, b));
  joints_.start(contacts);
  if (setup_.excavations.empty()) return;
  const Ring& outline = setup_.excavations.front().outline;
  reference_.height = diameter_of(outline, {0.0, 1.0}, model_, state);
  reference_.width = diameter_of(outline, {1.0, 0.0}, model_, state);
}

std::optional<double> DamageGauge::opening_width() const {
  if (setup_.excavations.empty()) return std::nullopt;
  return box_of(setup_.excavations.front().outline).size().x;
}

void DamageGauge::open(std::span<const int> excavations, const dynamics::State& state) {
  const std::vector<record::BlockStatus> status_now = status(state);
  for (Diameter* d : {&reference_.height, &reference_.width})
    d->closure = closure(*d, model_, state, status_now);  // 0 before the start
  for (const int e : excavations) reference_.open[at(e)] = 1;
  openings_.unite(setup_.excavations, reference_.open);
}

void DamageGauge::restore(Memory memory) {
  reference_ = std::move(memory.reference);
  joints_.restore(std::move(memory.pieces));
  openings_.unite(setup_.excavations, reference_.open);
}

Polygon DamageGauge::polygon_on_base(std::size_t block, const dynamics::State& state) const {
  Polygon polygon = deformed_polygon(model_, block);
  const Vec2 base = base_.displacement(state, model_.blocks[block].centroid);
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    for (Vec2& p : polygon.ring(r)) p -= base;
  }
  return polygon;
}

Vec2 DamageGauge::down() const {
  return model_.gravity == Vec2{} ? Vec2{0.0, -1.0} : normalized(model_.gravity);
}

double DamageGauge::fall_distance(const dynamics::Block& block) const {
  if (setup_.damage.fall_distance) return *setup_.damage.fall_distance;
  if (const std::optional<double> width = opening_width()) return 0.05 * *width;
  return model_.gravity == Vec2{} ? 0.0 : fall_share * std::sqrt(block.area);
}

Vec2 DamageGauge::place_on_base(std::size_t block, const dynamics::State& state) const {
  return centroid_now(model_.blocks[block], state) - base_.displacement(state, model_.blocks[block].centroid);
}

void DamageGauge::begin_stage(const dynamics::State& state) {
  if (!started()) return;
  reference_.of_stage.clear();
  for (std::size_t b = 0; b < model_.blocks.size(); ++b)
    reference_.of_stage.push_back(place_on_base(b, state));
}

Vec2 DamageGauge::displacement(std::size_t block, const dynamics::State& state) const {
  const Vec2 base = base_.displacement(state, model_.blocks[block].centroid) - reference_.base[block];
  return centroid_now(model_.blocks[block], state) - reference_.start[block] - base;
}

bool DamageGauge::is_beyond_fall(std::size_t block, const dynamics::State& state) const {
  const double fall = fall_distance(model_.blocks[block]);
  return fall > 0.0 && norm(displacement(block, state)) > fall;
}

std::vector<record::BlockStatus> DamageGauge::status(const dynamics::State& state) const {
  std::vector<record::BlockStatus> status(model_.blocks.size(), record::BlockStatus::in_place);
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.surface.present[b]) status[b] = record::BlockStatus::excavated;
    if (!started() || !model_.moves(b)) continue;
    const dynamics::Block& block = model_.blocks[b];
    const Vec2 moved = displacement(b, state);
    if (norm(moved) <= setup_.damage.loosened_distance && moving_[b] == 0) continue;
    status[b] = record::BlockStatus::loosened;
    const double fall = fall_distance(block);
    if (fall <= 0.0 || norm(moved) <= fall) continue;
    if (dot(moved, down()) > fall || openings_.area_inside(polygon_on_base(b, state)) > 0.5 * block.area)
      status[b] = record::BlockStatus::fallen;
  }
  return status;
}

double DamageGauge::speed(std::size_t b, const dynamics::State& state) const {
  const dynamics::Block& block = model_.blocks[b];
  const Vec2 velocity =
      Vec2{state.velocity[block.first], state.velocity[block.first + 1]} / std::sqrt(block.area);
  return norm(velocity - base_.velocity(state, block.centroid));
}

void DamageGauge::name_moving(std::span<const record::MovingBlock> moving) {
  moving_.assign(model_.blocks.size(), 0);
  for (const record::MovingBlock& block : moving) moving_[at(block.block)] = 1;
}

void DamageGauge::find_movers(const dynamics::State& state, record::StageRecord& record) const {
  std::vector<int> blocks;
  for (const record::FallenBlock& block : record.fallen) blocks.push_back(block.block);
  const bool anything_fell = !blocks.empty();
  for (const record::MovingBlock& block : record.moving)
    if (!anything_fell) blocks.push_back(block.block);
  if (blocks.empty() && record.unstable_block >= 0) blocks.push_back(record.unstable_block);
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    const double v = speed(b, state);
    record.largest_speed = std::max(record.largest_speed, v);
    if (v > setup_.damage.loosened_distance && !anything_fell &&
        record.stage.kind != record::StageKind::settle)
      blocks.push_back(static_cast<int>(b));
  }
  record::Movers& movers = record.movers;
  for (const int b : blocks) {
    const double weight = model_.blocks[at(b)].mass() * norm(model_.gravity);
    ++movers.blocks;
    movers.weight += weight;
    if (started()) movers.way = std::max(movers.way, norm(displacement(at(b), state)));
    if (movers.heaviest >= 0 && weight <= movers.heaviest_weight) continue;
    movers.heaviest = b;
    movers.heaviest_weight = weight;
  }
}

void DamageGauge::watch(const dynamics::State& state) {
  if (started()) joints_.watch(status(state));
}

std::vector<record::FallenBlock> DamageGauge::fallen(std::span<const record::BlockStatus> status) const {
  std::vector<record::FallenBlock> fallen;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (status[b] != record::BlockStatus::fallen) continue;
    const dynamics::Block& block = model_.blocks[b];
    const Openings::Place place = openings_.behind_walls(block.reference, down());
    fallen.push_back({static_cast<int>(b), block.area, block.mass() * norm(model_.gravity),
                      place.part == record::WallPart::none ? not_a_number : place.depth, place.part});
  }
  return fallen;
}

void DamageGauge::measure_way(std::size_t b, const dynamics::State& state, record::Damage& damage) const {
  damage.displacement_max = std::max(damage.displacement_max, norm(displacement(b, state)));
  if (!reference_.of_stage.empty())
    damage.stage_displacement =
        std::max(damage.stage_displacement, norm(place_on_base(b, state) - reference_.of_stage[b]));
  const double turned = std::remainder(turn_of(model_, b) - reference_.turn[b], 2.0 * std::numbers::pi);
  damage.rotation_max = std::max(damage.rotation_max, std::abs(turned) * 180.0 / std::numbers::pi);
}

record::Damage DamageGauge::measure(const dynamics::State& state) {
  record::Damage damage;
  if (!started()) return damage;
  const std::vector<record::BlockStatus> status_now = status(state);
  double inside = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    measure_way(b, state, damage);
    const bool goes = moving_[b] != 0 || speed(b, state) > setup_.damage.loosened_distance;
    if (goes || status_now[b] == record::BlockStatus::fallen) damage.moving_area += model_.blocks[b].area;
    if (status_now[b] == record::BlockStatus::loosened) damage.loosened_area += model_.blocks[b].area;
    if (status_now[b] != record::BlockStatus::in_place)
      inside += openings_.area_inside(polygon_on_base(b, state));
  }
  const double openings = openings_.area();
  if (openings > 0.0)
    damage.opening_filled_ratio = inside / openings;
  else
    damage.fallen_depth = damage.fallen_depth_crown = damage.fallen_depth_left = damage.fallen_depth_right =
        damage.fallen_depth_invert = not_a_number;
  const std::vector<record::FallenBlock> fallen_now = fallen(status_now);
  for (const record::FallenBlock& block : fallen_now) {
    ++damage.fallen_blocks;
    damage.fallen_area += block.area;
    damage.fallen_weight += block.weight;
  }
  record::set_extremes(fallen_now, damage);
  damage.largest_block_pressure = openings > 0.0 ? 0.0 : not_a_number;
  for (const record::FallenBlock& block : fallen_now) {
    if (openings == 0.0 || block.area < damage.largest_fallen_area) continue;
    const Polygon& place = model_.blocks[static_cast<std::size_t>(block.block)].reference;
    damage.largest_block_pressure = block.weight / record::width_along_wall(place, block.part, down());
    break;
  }
  joints_.watch(status_now);
  joints_.measure(status_now, damage);
  damage.closure_vertical = closure(reference_.height, model_, state, status_now);
  damage.closure_horizontal = closure(reference_.width, model_, state, status_now);
  return damage;
}

void DamageGauge::describe(const dynamics::State& state, record::StageRecord& record) {
  record.damage = measure(state);
  record.fallen = fallen(status(state));
  find_movers(state, record);
  if (setup_.excavations.empty())
    record.standing = record::standing_of(record, setup_.damage.loosened_distance, false);
}

}  // namespace keyblock::simulation
