#include "simulation/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact/bonded_edge.h"
#include "core/error.h"
#include "core/index.h"
#include "coupling/facets.h"
#include "cutting/interfaces.h"
#include "overlap/overlap.h"
#include "simulation/base.h"
#include "simulation/build_boundary.h"
#include "simulation/build_model.h"
#include "simulation/damping_table.h"
#include "simulation/elements.h"
#include "simulation/history_block.h"
#include "simulation/joint_records.h"

namespace keyblock::simulation {

// The state of a contact is recorded as the contact code has it.
static_assert(static_cast<int>(record::ContactState::open) == static_cast<int>(contact::State::open));
static_assert(static_cast<int>(record::ContactState::sliding) == static_cast<int>(contact::State::sliding));
static_assert(static_cast<int>(record::ContactState::locked) == static_cast<int>(contact::State::locked));

namespace {

std::vector<record::ColumnRecord> columns_of(const dynamics::Model& model) {
  std::vector<record::ColumnRecord> columns;
  for (const auto& coupling : model.couplings) {
    const dynamics::FarField* field = coupling->far_field();
    if (field == nullptr) continue;
    for (const dynamics::FarRock& far : field->far_rock()) {
      const std::span<const double> heights = far.column.heights();
      record::ColumnRecord column{far.x, heights.front(), heights.back()};
      for (std::size_t k = 1; k < heights.size(); ++k)
        column.longest_element = std::max(column.longest_element, heights[k] - heights[k - 1]);
      columns.push_back(column);
    }
  }
  return columns;
}

std::vector<record::LayerRecord> records_of(std::span<const dynamics::RockLayer> layers) {
  std::vector<record::LayerRecord> records;
  for (const dynamics::RockLayer& layer : layers)
    records.push_back({layer.top, layer.density, layer.speeds()});
  return records;
}

record::BoundaryRecord record_of(const Boundary& boundary) {
  return {.compliant = boundary.compliant,
          .sides = boundary.sides,
          .overburden = boundary.overburden,
          .dashpots = boundary.dashpots,
          .layers = records_of(boundary.layers),
          .right_layers = records_of(boundary.right_layers),
          .source = boundary.source};
}

void put_forces(std::span<const dynamics::ContactForce> forces, std::span<record::ContactRecord> to) {
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const dynamics::ContactForce& force = forces[k];
    to[k].state = static_cast<record::ContactState>(force.state);
    to[k].gap = force.gap;
    to[k].normal_force = force.normal;
    to[k].shear_force = force.shear;
  }
}

bool may_break(const dynamics::Model& model) {
  return std::ranges::any_of(model.laws, &contact::JointLaw::may_break) || may_rupture(model);
}

record::BreakMode mode_of(contact::BreakMode mode) {
  if (mode == contact::BreakMode::shear) return record::BreakMode::shear;
  return mode == contact::BreakMode::opening ? record::BreakMode::opening : record::BreakMode::tension;
}

void put_strengths(const dynamics::Model& model, std::span<const contact::Contact> contacts,
                   std::span<record::ContactRecord> to) {
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const contact::Contact& c = contacts[k];
    to[k].friction = c.friction_coefficient;
    to[k].cohesion = c.length > 0.0 ? c.cohesion / c.length : 0.0;
    to[k].tension = c.length > 0.0 ? c.tension / c.length : 0.0;
    const int edge = contact::bonded_edge(model.surface, model.laws, c);
    to[k].strength_left = model.laws[at(model.surface.joint_of(edge, c.block_a, c.block_b))].strength_left(
        c.memory.worn, c.memory.bonded);
  }
}

}  // namespace

Recorder::Recorder(const RunSetup& setup, const dynamics::Model& model, const DamageGauge& gauge, int threads)
    : setup_(setup), model_(model), gauge_(gauge), threads_(threads) {
  std::vector<cutting::EdgeLabel> of_outline;
  for (const cutting::CutBlock& block : setup.system.blocks) {
    for (const auto& ring : block.labels) of_outline.insert(of_outline.end(), ring.begin(), ring.end());
  }
  for (const int edge : model.outline_edge) {
    labels_.push_back(at(edge) < of_outline.size()
                          ? of_outline[at(edge)]
                          : cutting::EdgeLabel{cutting::EdgeKind::domain, 0});  // of the frame
  }
  for (const History& history : setup.histories) {
    if (history.element.empty()) {
      points_.push_back(point_of(history));
      point_names_.push_back(history.name);
    } else {
      element_histories_.push_back({history.name, element_of(model, history)});
    }
  }
  orders_changed();
}

Recorder::Point Recorder::point_of(const History& history) const {
  if (history.column) {
    const Box sides = boundary_box(setup_);
    const double x = *history.column == ColumnSide::left ? sides.min.x : sides.max.x;
    return {std::nullopt, {x, history.point.y}, {}, history.absolute};
  }
  const std::optional<std::size_t> block = history_block(setup_, history);
  if (!block) {
    Diagnostic diagnostic;
    diagnostic.key = fmt::format("history '{}'", history.name);
    diagnostic.found = fmt::format("the point ({}, {})", history.point.x, history.point.y);
    diagnostic.expected = "a point in a block";
    throw InputError(std::move(diagnostic));
  }
  return {block, history.point, {}, history.absolute};
}

void Recorder::orders_changed() {
  for (Point& point : points_) {
    if (!point.block) continue;
    const dynamics::Block& block = model_.blocks[*point.block];
    point.phi.resize(at(block.size));
    block.basis.evaluate(point.reference, point.phi.data());
  }
}

record::ModelRecord Recorder::model() const {
  record::ModelRecord record;
  record.title = setup_.title;
  record.version = setup_.version;
  record.seed = setup_.seed;
  record.realization = setup_.realization;
  record.threads = threads_;
  record.step_size = setup_.time_step;
  record.origin = setup_.system.origin;
  record.scenario = setup_.scenario;
  record.warnings = setup_.warnings;
  record.hooks = setup_.hooks;
  record.closure_is_lower_bound = setup_.closure_is_lower_bound;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    const dynamics::Block& block = model_.blocks[b];
    record::ModelRecord::Block row;
    const bool is_frame = b >= setup_.properties.size();
    row.name = is_frame ? "frame" : setup_.properties[b].name;
    row.order = block.basis.order();
    row.fixed = block.fixed;
    row.area = block.area;
    row.density = block.material.density;
    row.young = block.material.young;
    row.poisson = block.material.poisson;
    if (!block.fixed && block.material.state == block::PlaneState::plane_strain)
      row.stress_ratio_zz = block.material.poisson;
    if (!is_frame) row.excavations = setup_.system.blocks[b].excavations;
    row.centroid = block.centroid;
    const contact::Surface& surface = model_.surface;
    for (int v = surface.block_begin[b]; v < surface.block_begin[b + 1]; ++v) {
      if (surface.previous[at(v)] >= v) row.ring_start.push_back(v);  // the first vertex of a ring
    }
    row.ring_start.push_back(surface.block_begin[b + 1]);
    record.blocks.push_back(std::move(row));
  }
  record.vertices = model_.reference;
  record.edge_label = labels_;
  for (const record::Stage& stage : setup_.stages) record.stage_names.push_back(stage.name);
  record.joint_set_names = setup_.joint_set_names;
  record.trace_map_names = setup_.trace_map_names;
  record.joints = joint_records(setup_);
  record.strengths = setup_.joints.drawn;
  record.may_break = may_break(model_);
  record.elements = element_descriptions(model_);
  for (const Excavation& excavation : setup_.excavations) {
    record.excavation_names.push_back(excavation.name);
    record.excavation_outlines.push_back(excavation.outline);
  }
  record.history_names = point_names_;
  record.element_histories = element_histories_;
  record.opening_width = gauge_.opening_width();
  record.slip_limit = setup_.damage.slip;
  record.opening_limit = setup_.damage.opening;
  record.cutting = setup_.system.statistics;
  record.ground = setup_.ground;
  record.damping = damping_table(setup_);
  if (setup_.boundary) record.boundary = record_of(*setup_.boundary);
  record.columns = columns_of(model_);
  return record;
}

record::Frame Recorder::frame(const dynamics::State& state, int stage) const {
  record::Frame frame;
  frame.time = state.time;
  frame.stage = stage;
  frame.step = state.step;
  frame.displacement.reserve(model_.reference.size());
  for (std::size_t v = 0; v < model_.reference.size(); ++v) {
    const Vec2 u = model_.surface.position[v] - model_.reference[v];
    frame.displacement.push_back({static_cast<float>(u.x), static_cast<float>(u.y)});
  }
  for (const dynamics::Block& block : model_.blocks) {
    const block::Stress s =
        block.fixed ? block::Stress{} : block.elasticity.mean_cauchy(&state.position[block.first]);
    frame.stress.push_back({static_cast<float>(s.xx), static_cast<float>(s.yy), static_cast<float>(s.xy)});
    // The first basis function is constant, 1/√area.
    const double scale = 1.0 / std::sqrt(block.area);
    frame.velocity.push_back({static_cast<float>(scale * state.velocity[block.first]),
                              static_cast<float>(scale * state.velocity[block.first + 1])});
    frame.order.push_back(static_cast<std::int16_t>(block.basis.order()));
  }
  frame.status = gauge_.status(state);
  frame.elements = element_states(model_, state);
  return frame;
}

record::ContactFrame Recorder::contacts(const dynamics::State& state, const dynamics::Stepper& stepper,
                                        int stage) const {
  record::ContactFrame frame;
  frame.time = state.time;
  frame.stage = stage;
  frame.step = state.step;
  frame.contacts.reserve(stepper.force_count());
  each_contact(stepper, [&](std::span<const record::ContactRecord> some) {
    frame.contacts.insert(frame.contacts.end(), some.begin(), some.end());
  });
  put_water(state, frame.contacts);
  return frame;
}

void Recorder::each_contact(const dynamics::Stepper& stepper, const record::TakeContacts& take,
                            record::ContactParts parts) const {
  constexpr std::size_t at_a_time = 64;
  std::array<dynamics::ContactForce, at_a_time> forces;
  std::array<record::ContactRecord, at_a_time> records;
  std::array<double, at_a_time> slips;
  const auto contacts = stepper.contacts();
  for (std::size_t first = 0; first < stepper.force_count(); first += at_a_time) {
    const std::size_t count = std::min(at_a_time, stepper.force_count() - first);
    const auto some = contacts.subspan(first, count);
    if (parts.places) put_places(some, records);
    if (parts.strengths) put_strengths(model_, some, records);
    if (parts.forces) {
      stepper.forces(first, std::span(forces).first(count));
      put_forces(std::span(forces).first(count), records);
    }
    if (parts.slips) {
      gauge_.joints().slips(some, std::span(slips).first(count));
      for (std::size_t k = 0; k < count; ++k) records[k].shear_displacement = slips[k];
    }
    take(std::span(records).first(count));
  }
}

cutting::EdgeLabel Recorder::label_of(int edge, int block_a, int block_b) const {
  return cutting::joint_between(setup_.system, at(block_a), at(block_b)).value_or(labels_[at(edge)]);
}

std::vector<record::BreakRecord> Recorder::breaks(const dynamics::State& state,
                                                  std::span<const dynamics::JointBreak> joints,
                                                  std::span<const int> elements) const {
  std::vector<record::BreakRecord> rows;
  const record::BreakRecord now{.time = state.time, .step = state.step};
  for (const dynamics::JointBreak& joint : joints) {
    const cutting::EdgeLabel label = label_of(joint.edge, joint.block_a, joint.block_b);
    record::BreakRecord& row = rows.emplace_back(now);
    row.mode = mode_of(joint.mode);
    row.position = joint.position;
    row.length = joint.length;
    row.block_a = joint.block_a;
    row.block_b = joint.block_b;
    row.kind = label.kind;
    row.index = label.index;
    row.trace = label.trace;
  }
  if (elements.empty()) return rows;
  const std::vector<record::ElementDescription> descriptions = element_descriptions(model_);
  const std::vector<record::ElementState> states = element_states(model_, state);
  for (const int element : elements) {
    const record::ElementDescription& of = descriptions[at(element)];
    record::BreakRecord& row = rows.emplace_back(now);
    row.position = 0.5 * (states[at(element)].from + states[at(element)].to);
    row.block_a = of.from_block;
    row.block_b = of.to_block;
    row.element = element;
  }
  return rows;
}

void Recorder::put_places(std::span<const contact::Contact> contacts,
                          std::span<record::ContactRecord> to) const {
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const contact::Contact& c = contacts[k];
    record::ContactRecord& row = to[k];
    row.block_a = c.block_a;
    row.block_b = c.block_b;
    row.vertex = c.vertex;
    row.edge = c.edge;
    row.position = model_.surface.position[at(c.vertex)];
    row.normal = c.normal;
    row.length = c.length;
    row.label = label_of(c.edge, c.block_a, c.block_b);
  }
}

void Recorder::put_water(const dynamics::State& state, std::span<record::ContactRecord> to) const {
  const dynamics::WaterOfModel water = dynamics::water_of(model_, state);
  if (water.water == nullptr) return;
  std::vector<dynamics::EdgePlace> places;
  for (const record::ContactRecord& c : to) places.push_back({c.edge, model_.reference[at(c.vertex)]});
  const std::vector<double> pressures = water.water->pressures(model_, state, water.memory, places);
  for (std::size_t k = 0; k < to.size(); ++k) to[k].water_pressure = pressures[k];
}

bool Recorder::is_there(const Point& point) const {
  return !point.block || model_.surface.present[*point.block] != 0;
}

dynamics::GroundMove Recorder::move_of(const Point& point, const dynamics::State& state,
                                       const dynamics::GroundMove& frame) const {
  dynamics::GroundMove move;
  if (!point.block) {
    move = far_ground(model_, state, point.reference);
  } else {
    const dynamics::Block& block = model_.blocks[*point.block];
    Vec2 x, v;
    for (std::size_t k = 0; k < point.phi.size(); ++k) {
      x += point.phi[k] * Vec2{state.position[block.first + 2 * k], state.position[block.first + 2 * k + 1]};
      v += point.phi[k] * Vec2{state.velocity[block.first + 2 * k], state.velocity[block.first + 2 * k + 1]};
    }
    move = {x - point.reference, v};
  }
  if (point.absolute) {
    move.displacement += frame.displacement;
    move.velocity += frame.velocity;
  }
  return move;
}

std::vector<Vec2> Recorder::velocities(const dynamics::State& state,
                                       const dynamics::GroundMove& frame) const {
  std::vector<Vec2> velocities;
  for (const Point& point : points_) velocities.push_back(move_of(point, state, frame).velocity);
  return velocities;
}

record::HistoryRow Recorder::history(const dynamics::State& state, const dynamics::GroundMove& frame,
                                     std::span<const Vec2> before) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  record::HistoryRow row;
  row.time = state.time;
  row.step = state.step;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Point& point = points_[k];
    if (!is_there(point)) {
      row.points.push_back({none, none, none, none, none, none, none, none, none});
      continue;
    }
    const auto [u, v] = move_of(point, state, frame);
    block::Stress s{none, none, none};
    if (point.block) {
      const dynamics::Block& block = model_.blocks[*point.block];
      s = block.elasticity.cauchy(&state.position[block.first], block.basis, point.reference);
    }
    const Vec2 a = before.empty() ? Vec2{} : (v - before[k]) / setup_.time_step;
    row.points.push_back({u.x, u.y, v.x, v.y, s.xx, s.yy, s.xy, a.x, a.y});
  }
  put_element_histories(state, row);
  return row;
}

void Recorder::put_element_histories(const dynamics::State& state, record::HistoryRow& row) const {
  if (element_histories_.empty()) return;
  const std::vector<record::ElementState> all = element_states(model_, state);
  for (const record::ElementHistory& history : element_histories_) {
    record::ElementState& element = row.elements.emplace_back(all[at(history.element)]);
    if (element.present) continue;
    for (const record::ElementStateField& field : record::element_state_fields)
      element.*field.number = std::numeric_limits<double>::quiet_NaN();
  }
}

std::optional<record::OverlapRecord> Recorder::overlap(const dynamics::State& state, int stage,
                                                       double least_depth) const {
  std::vector<Polygon> polygons;
  std::vector<int> blocks;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (model_.surface.present[b] == 0) continue;
    polygons.push_back(deformed_polygon(model_, b));
    blocks.push_back(static_cast<int>(b));
  }
  const overlap::Overlap found = overlap::largest_overlap(polygons, least_depth);
  if (found.block_a < 0) return std::nullopt;
  return record::OverlapRecord{
      found.depth, blocks[at(found.block_a)],    blocks[at(found.block_b)], found.where,
      state.time,  setup_.stages[at(stage)].name};
}

double Recorder::area_change(const dynamics::State& state) const {
  double largest = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    const dynamics::Block& block = model_.blocks[b];
    largest = std::max(largest, std::abs(block.pose.area(&state.position[block.first]) / block.area - 1.0));
  }
  return largest;
}

}  // namespace keyblock::simulation
