#include "sample_run.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "record/break_records.h"
#include "record/damage_fields.h"

namespace keyblock::results {
namespace {

constexpr double step_size = 0.1 + 0.2 - 0.299;  // no round number

double noise(long seed, int k) {
  std::mt19937_64 random(static_cast<unsigned long>(seed * 1000 + k));
  const double mantissa = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
  return std::ldexp(mantissa, static_cast<int>(random() % 60) - 30);
}

template <class T>
bool same(T a, T b) {
  if constexpr (sizeof(T) == 8)
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  else
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool same(Vec2 a, Vec2 b) {
  return same(a.x, b.x) && same(a.y, b.y);
}

void expect_equal(const record::ModelRecord& a, const record::ModelRecord& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.version, b.version);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.realization, b.realization);
  EXPECT_EQ(a.threads, b.threads);
  EXPECT_TRUE(same(a.step_size, b.step_size));
  EXPECT_TRUE(same(a.origin, b.origin));
  EXPECT_EQ(a.scenario, b.scenario);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t k = 0; k < a.blocks.size(); ++k) {
    EXPECT_EQ(a.blocks[k].name, b.blocks[k].name);
    EXPECT_EQ(a.blocks[k].order, b.blocks[k].order);
    EXPECT_EQ(a.blocks[k].fixed, b.blocks[k].fixed);
    EXPECT_TRUE(same(a.blocks[k].area, b.blocks[k].area));
    EXPECT_TRUE(same(a.blocks[k].density, b.blocks[k].density));
    EXPECT_EQ(a.blocks[k].excavations, b.blocks[k].excavations);
    EXPECT_TRUE(same(a.blocks[k].centroid, b.blocks[k].centroid));
    EXPECT_EQ(a.blocks[k].ring_start, b.blocks[k].ring_start);
    EXPECT_TRUE(same(a.blocks[k].stress_ratio_zz, b.blocks[k].stress_ratio_zz));
    EXPECT_TRUE(same(a.blocks[k].young, b.blocks[k].young));
    EXPECT_TRUE(same(a.blocks[k].poisson, b.blocks[k].poisson));
  }
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.edge_label, b.edge_label);
  EXPECT_EQ(a.stage_names, b.stage_names);
  EXPECT_EQ(a.joint_set_names, b.joint_set_names);
  EXPECT_EQ(a.trace_map_names, b.trace_map_names);
  EXPECT_EQ(a.excavation_names, b.excavation_names);
  EXPECT_EQ(a.excavation_outlines, b.excavation_outlines);
  EXPECT_EQ(a.history_names, b.history_names);
  EXPECT_EQ(a.may_break, b.may_break);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.element_histories, b.element_histories);
  EXPECT_EQ(a.opening_width, b.opening_width);
  EXPECT_EQ(a.slip_limit, b.slip_limit);
  EXPECT_EQ(a.opening_limit, b.opening_limit);
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.closure_is_lower_bound, b.closure_is_lower_bound);
  EXPECT_EQ(a.cutting.traces, b.cutting.traces);
  EXPECT_EQ(a.cutting.joints_used, b.cutting.joints_used);
  EXPECT_EQ(a.cutting.removed_pieces, b.cutting.removed_pieces);
  EXPECT_EQ(a.cutting.merged_slivers, b.cutting.merged_slivers);
  EXPECT_EQ(a.cutting.merged_vertices, b.cutting.merged_vertices);
  EXPECT_TRUE(same(a.cutting.trace_length, b.cutting.trace_length));
  EXPECT_TRUE(same(a.cutting.removed_length, b.cutting.removed_length));
  EXPECT_TRUE(same(a.cutting.domain_area, b.cutting.domain_area));
  EXPECT_TRUE(same(a.cutting.sliver_area, b.cutting.sliver_area));
  EXPECT_EQ(a.cutting.merged_across_joints, b.cutting.merged_across_joints);
  EXPECT_TRUE(same(a.cutting.highest_tooth, b.cutting.highest_tooth));
  EXPECT_EQ(a.cutting.slivers_left, b.cutting.slivers_left);
}

void expect_equal(const record::Energy& a, const record::Energy& b) {
  using E = record::Energy;
  for (const auto member : {&E::kinetic, &E::strain, &E::gravity, &E::contact, &E::friction, &E::damping,
                            &E::input, &E::numerical, &E::residual_ratio}) {
    EXPECT_TRUE(same(a.*member, b.*member));
  }
}

void expect_equal(const record::Frame& a, const record::Frame& b) {
  EXPECT_TRUE(same(a.time, b.time));
  EXPECT_EQ(a.stage, b.stage);
  EXPECT_EQ(a.step, b.step);
  ASSERT_EQ(a.displacement.size(), b.displacement.size());
  ASSERT_EQ(a.stress.size(), b.stress.size());
  for (std::size_t k = 0; k < a.displacement.size(); ++k) {
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(same(a.displacement[k][i], b.displacement[k][i]));
  }
  for (std::size_t k = 0; k < a.stress.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(same(a.stress[k][i], b.stress[k][i]));
  }
  ASSERT_EQ(a.velocity.size(), b.velocity.size());
  for (std::size_t k = 0; k < a.velocity.size(); ++k) {
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(same(a.velocity[k][i], b.velocity[k][i]));
  }
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.order, b.order);
  ASSERT_EQ(a.elements.size(), b.elements.size());
  for (std::size_t k = 0; k < a.elements.size(); ++k) {
    const auto &p = a.elements[k], &q = b.elements[k];
    EXPECT_TRUE(same(p.from, q.from) && same(p.to, q.to));
    EXPECT_TRUE(same(p.force, q.force) && same(p.elongation, q.elongation) && same(p.yielded, q.yielded));
    EXPECT_EQ(p.present, q.present);
  }
}

void expect_equal(const record::ContactFrame& a, const record::ContactFrame& b) {
  EXPECT_TRUE(same(a.time, b.time));
  EXPECT_EQ(a.stage, b.stage);
  EXPECT_EQ(a.step, b.step);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    const auto &p = a.contacts[k], &q = b.contacts[k];
    EXPECT_EQ(p.block_a, q.block_a);
    EXPECT_EQ(p.block_b, q.block_b);
    EXPECT_EQ(p.state, q.state);
    EXPECT_TRUE(same(p.position, q.position) && same(p.normal, q.normal));
    EXPECT_TRUE(same(p.length, q.length) && same(p.gap, q.gap) &&
                same(p.shear_displacement, q.shear_displacement));
    EXPECT_TRUE(same(p.normal_force, q.normal_force) && same(p.shear_force, q.shear_force));
    EXPECT_EQ(p.label, q.label);
  }
}

void expect_equal(const record::HistoryRow& a, const record::HistoryRow& b) {
  EXPECT_TRUE(same(a.time, b.time));
  EXPECT_EQ(a.step, b.step);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    const auto &p = a.points[k], &q = b.points[k];
    EXPECT_TRUE(same(p.ux, q.ux) && same(p.uy, q.uy) && same(p.vx, q.vx) && same(p.vy, q.vy));
    EXPECT_TRUE(same(p.sxx, q.sxx) && same(p.syy, q.syy) && same(p.sxy, q.sxy));
    EXPECT_TRUE(same(p.ax, q.ax) && same(p.ay, q.ay));
  }
  ASSERT_EQ(a.elements.size(), b.elements.size());
  for (std::size_t k = 0; k < a.elements.size(); ++k) {
    EXPECT_TRUE(same(a.elements[k].force, b.elements[k].force));
    EXPECT_TRUE(same(a.elements[k].elongation, b.elements[k].elongation));
  }
}

void expect_equal(const record::BreakRecord& a, const record::BreakRecord& b) {
  record::visit_fields(record::break_fields, [&]<class Row, class T>(const record::RowField<Row, T>& field) {
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, Vec2>)
      EXPECT_TRUE(same(a.*field.member, b.*field.member)) << field.name;
    else
      EXPECT_EQ(a.*field.member, b.*field.member) << field.name;
  });
}

void expect_equal(const record::BreakCount& a, const record::BreakCount& b) {
  EXPECT_EQ(std::tuple(a.kind, a.index, a.element, a.mode, a.events),
            std::tuple(b.kind, b.index, b.element, b.mode, b.events));
  EXPECT_TRUE(same(a.length, b.length) && same(a.first, b.first) && same(a.last, b.last));
  EXPECT_EQ(std::pair(a.first_stage, a.last_stage), std::pair(b.first_stage, b.last_stage));
}

void expect_equal(const record::StepRow& a, const record::StepRow& b) {
  EXPECT_TRUE(same(a.time, b.time) && same(a.step_size, b.step_size));
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.stage, b.stage);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_TRUE(same(a.penetration, b.penetration) && same(a.max_displacement, b.max_displacement));
  EXPECT_EQ(a.closed_contacts, b.closed_contacts);
  expect_equal(a.energy, b.energy);
}

void expect_equal(const record::StageRecord& a, const record::StageRecord& b) {
  EXPECT_EQ(a.stage.name, b.stage.name);
  EXPECT_EQ(a.stage.kind, b.stage.kind);
  EXPECT_EQ(a.stage.excavate, b.stage.excavate);
  EXPECT_EQ(a.stage.motion, b.stage.motion);
  EXPECT_EQ(a.stage.scale, b.stage.scale);
  EXPECT_EQ(a.stage.duration, b.stage.duration);
  EXPECT_EQ(a.stage.max_steps, b.stage.max_steps);
  EXPECT_EQ(a.stage.tolerance, b.stage.tolerance);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_TRUE(same(a.start_time, b.start_time) && same(a.duration, b.duration) && same(a.pga, b.pga));
  EXPECT_EQ(a.planned_duration, b.planned_duration);
  EXPECT_TRUE(same(a.pgv, b.pgv) && same(a.arias, b.arias));
  EXPECT_EQ(a.equilibrium_reached, b.equilibrium_reached);
  EXPECT_TRUE(same(a.worst_residual_ratio, b.worst_residual_ratio));
  EXPECT_TRUE(same(a.way, b.way) && same(a.way_share, b.way_share));
  ASSERT_EQ(a.moving.size(), b.moving.size());
  for (std::size_t k = 0; k < a.moving.size(); ++k) {
    EXPECT_EQ(a.moving[k].block, b.moving[k].block);
    EXPECT_TRUE(same(a.moving[k].carried, b.moving[k].carried));
    EXPECT_EQ(a.moving[k].group, b.moving[k].group);
  }
  ASSERT_EQ(a.release.size(), b.release.size());
  for (std::size_t k = 0; k < a.release.size(); ++k) {
    const record::ReleasePoint &p = a.release[k], &q = b.release[k];
    EXPECT_EQ(p.step, q.step);
    EXPECT_EQ(p.excavation, q.excavation);
    EXPECT_TRUE(same(p.released, q.released) && same(p.crown, q.crown));
    EXPECT_TRUE(same(p.springline, q.springline) && same(p.mean, q.mean));
  }
  EXPECT_EQ(a.damage.fallen_blocks, b.damage.fallen_blocks);
  for (const auto& field : record::damage_fields)
    EXPECT_TRUE(same(a.damage.*field.number, b.damage.*field.number)) << field.name;
  ASSERT_EQ(a.fallen.size(), b.fallen.size());
  for (std::size_t k = 0; k < a.fallen.size(); ++k) {
    EXPECT_EQ(a.fallen[k].block, b.fallen[k].block);
    EXPECT_EQ(a.fallen[k].part, b.fallen[k].part);
    EXPECT_TRUE(same(a.fallen[k].area, b.fallen[k].area) && same(a.fallen[k].weight, b.fallen[k].weight) &&
                same(a.fallen[k].depth, b.fallen[k].depth));
  }
  EXPECT_EQ(a.damage.hinges, b.damage.hinges);
  EXPECT_EQ(a.standing, b.standing);
  EXPECT_TRUE(same(a.largest_speed, b.largest_speed));
  EXPECT_TRUE(same(a.wall_time, b.wall_time));
  EXPECT_EQ(a.interrupted, b.interrupted);
  EXPECT_EQ(a.motion_time, b.motion_time);
  EXPECT_EQ(a.motion, b.motion);
}

template <class Rows>
void expect_equal_rows(const Rows& a, const Rows& b, const char* what) {
  SCOPED_TRACE(what);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_equal(a[k], b[k]);
}

}  // namespace

SampleRun::SampleRun() {
  model.title = "A \"sample\" – with µ, <tags> & more";
  model.version = "0.1.0";
  model.seed = 18446744073709551557ULL;
  model.realization = 3;
  model.threads = 2;
  model.step_size = step_size;
  model.origin = {466000.1, 6691600.7};
  model.scenario = "title = \"x\"\n# set rock.order=2\n";
  model.blocks = {{"base", 1, true, 0.5, 2270.0, {}, {1.0 / 3.0, 1.0 / 3.0}, {0, 3}},
                  {"", 2, false, 15.0, 2600.5, {0, 1}, {5.0, 5.0}, {3, 7, 11}},
                  {"slider", 1, false, 0.5, 2270.0, {1}, {7.0, 0.1}, {11, 14}}};
  model.blocks.back().stress_ratio_zz = 0.1 + 0.2;
  for (auto& block : model.blocks) {
    block.young = block.density * 1e6 / 3.0;
    block.poisson = 0.1 + 0.2;
  }
  model.vertices = {{0, 0},     {1, 0},     {0, 1},     {3, 3},     {7, 3}, {7, 7}, {3, 7},
                    {4.5, 4.5}, {4.5, 5.5}, {5.5, 5.5}, {5.5, 4.5}, {7, 0}, {8, 0}, {7, 1}};
  for (std::size_t k = 0; k < model.vertices.size(); ++k) {
    model.edge_label.push_back({static_cast<cutting::EdgeKind>(k % 5), static_cast<std::int16_t>(k)});
  }
  model.stage_names = {"in situ", "first \"earthquake\"", "after"};
  model.joint_set_names = {"J1", "J 2"};
  model.trace_map_names = {"map"};
  model.excavation_names = {"tunnel", "niche"};
  model.excavation_outlines = {{{0, 0}, {1, 0}, {0.1, 1}}, {}};
  model.history_names = {"crown", "a/b, \"c\""};
  model.elements = {{"anchor, \"3\"", "spring", 1e5 / 3.0, {0.1, 0.2}, {5.0, 5.5}, 0, 1, 1.5},
                    {"boundary.base", "boundary", HUGE_VAL, {0.0, 0.0}, {8.0, 0.0}, -1, 2}};
  model.may_break = true;
  model.element_histories = {{"load cell", 0}};
  model.opening_width = 5.5;
  model.slip_limit = 0.1 / 3.0;
  model.warnings = {"rock.density = 2.6 kg/m3", "a \"quoted\" one"};
  model.closure_is_lower_bound = true;
  model.cutting = {10, 7, 12.3, 4.5, 6, 2.5, 2, 1, 0.02, 3, 8, 16.0, 1e-5};
  model.ground = {{"friction φ", "30°"}, {"set “J 2”", "dip 65°, \"spacing\" 0.5 m"}};
}

record::Frame SampleRun::frame(int stage, long step) {
  record::Frame frame;
  frame.time = stage == 0 ? 0.0 : static_cast<double>(step - 10) * step_size;
  frame.stage = stage;
  frame.step = step;
  for (int k = 0; k < static_cast<int>(model.vertices.size()); ++k) {
    frame.displacement.push_back(
        {static_cast<float>(noise(step, 2 * k)), static_cast<float>(noise(step, 2 * k + 1))});
  }
  for (int k = 0; k < static_cast<int>(model.blocks.size()); ++k) {
    frame.stress.push_back(
        {static_cast<float>(noise(step, 100 + k)), -0.0F, std::numeric_limits<float>::denorm_min()});
    frame.status.push_back(static_cast<record::BlockStatus>((step + k) % 4));
    frame.velocity.push_back(
        {static_cast<float>(noise(step, 200 + k)), static_cast<float>(noise(step, 300 + k))});
    frame.order.push_back(static_cast<std::int16_t>(1 + (step + k) % 300));
  }
  for (int k = 0; k < static_cast<int>(model.elements.size()); ++k) {
    frame.elements.push_back({.from = {noise(step, 400 + k), noise(step, 410 + k)},
                              .to = {noise(step, 420 + k), 0.1 / 3.0},
                              .force = noise(step, 430 + k),
                              .elongation = noise(step, 440 + k),
                              .yielded = noise(step, 450 + k),
                              .moment = noise(step, 460 + k),
                              .shear = noise(step, 470 + k),
                              .utilization = noise(step, 480 + k),
                              .present = (step + k) % 3 != 0});
  }
  return frame;
}

record::ContactFrame SampleRun::contacts(int stage, long step, int count) {
  record::ContactFrame frame{static_cast<double>(step) * step_size, stage, {}, step};
  for (int k = 0; k < count; ++k) {
    frame.contacts.push_back({k % 3,
                              (k + 1) % 3,
                              static_cast<record::ContactState>(k % 3),
                              {noise(step, k), noise(step, k + 1)},
                              {0.6, 0.8},
                              noise(step, k + 2),
                              noise(step, k + 3),
                              noise(step, k + 4),
                              noise(step, k + 5),
                              noise(step, k + 6),
                              {cutting::EdgeKind::joint_set, static_cast<std::int16_t>(-k)}});
  }
  return frame;
}

record::HistoryRow SampleRun::history(long step) {
  record::HistoryRow row;
  row.time = static_cast<double>(step) * step_size;
  row.step = step;
  for (int k = 0; k < 2; ++k) {
    row.points.push_back({noise(step, k), noise(step, k + 2), noise(step, k + 4), noise(step, k + 6),
                          noise(step, k + 8), 1e300, -5e-324, noise(step, k + 10), noise(step, k + 12)});
  }
  for (std::size_t k = 0; k < model.element_histories.size(); ++k) {
    record::ElementState& element = row.elements.emplace_back();
    element.force = step < 4 ? std::nan("") : noise(step, 14);
    element.elongation = step < 4 ? std::nan("") : noise(step, 15);
  }
  return row;
}

record::BreakRecord SampleRun::break_at(int stage, long step) {
  record::BreakRecord row;
  row.time = static_cast<double>(step) * step_size;
  row.stage = stage;
  row.step = step;
  row.mode = step % 2 == 0 ? record::BreakMode::shear : record::BreakMode::tension;
  row.position = {noise(step, 1), noise(step, 2)};
  row.block_a = step % 4 == 0 ? -1 : 2;
  row.block_b = 1;
  if (step % 3 == 0 && model.elements.size() > 1) {
    row.element = 1;
  } else {
    row.length = std::abs(noise(step, 3));
    row.kind = cutting::EdgeKind::trace_map;
    row.trace = 12;
  }
  return row;
}

record::StepRow SampleRun::step_row(int stage, long step) {
  record::StepRow row{static_cast<double>(step) * step_size,
                      step,
                      stage,
                      3,
                      step_size,
                      noise(step, 1),
                      noise(step, 2),
                      17,
                      {}};
  row.energy = {noise(step, 3), noise(step, 4),  noise(step, 5),
                noise(step, 6), noise(step, 7),  noise(step, 8),
                noise(step, 9), noise(step, 10), 1e-3};
  return row;
}

record::StageRecord SampleRun::stage(int index) {
  record::StageRecord record;
  record.stage.name = index == 0 ? "in situ" : "first \"earthquake\"";
  record.stage.kind = index == 0 ? record::StageKind::settle : record::StageKind::shake;
  if (index == 0) record.stage.excavate = {0};
  if (index == 0) record.stage.max_steps = 500;
  if (index == 1) {
    record.stage.motion = 0;
    record.stage.scale = 0.3;
    record.stage.duration = 20 * step_size;
    record.planned_duration = 20 * step_size;
    record.pga = noise(1, 1);
    record.pgv = noise(1, 2);
    record.arias = noise(1, 3);
    record.motion_time = {0.0, 0.1, 0.2};
    record.motion = {{0.1, 0.2}, {0.3, -0.4}, {0.0, 0.0}};
  }
  record.steps = index == 0 ? 10 : 20;
  record.start_time = 0.0;
  record.duration = index == 0 ? 0.0 : 20 * step_size;
  record.equilibrium_reached = index == 0;
  record.worst_residual_ratio = index == 0 ? 0.1 / 3.0 : std::nan("");
  if (index == 0) record.moving = {{2, 0.7, 1}};
  if (index == 0) record.release = {{3, 0.0, 0.0, 0.0, 0.0, 0}, {9, 0.4, 2e-3, std::nan(""), 1e-3, 0}};
  if (index == 0) record.way = 0.25, record.way_share = 0.1 / 3.0;
  record.damage.fallen_blocks = index;
  record.damage.hinges = 7 * index;
  record.largest_speed = noise(index, 5);
  if (index > 0) record.standing = record::Standing::collapsed;
  double value = noise(index, 1);
  for (const auto& field : record::damage_fields) record.damage.*field.number = value *= -0.7;
  record.damage.closure_horizontal = 1e-17;
  record.fallen = {{0, noise(index, 2), noise(index, 3), noise(index, 4), record::WallPart::invert},
                   {2, 0.1, 0.0, std::numeric_limits<double>::quiet_NaN(), record::WallPart::none}};
  record.wall_time = 1.0 / 3.0;
  return record;
}

record::RunRecord SampleRun::run() {
  record::RunRecord record;
  record.steps = 30;
  record.wall_time = 2.0 / 3.0;
  record.dof = 36;
  record.state_hash = "0123456789abcdef";
  record.open_close = {3.7, 9, 2, 0};
  record.max_overlap = {1.0 / 7.0, 0, 2, {0.1, -2.5}, 1.0 / 3.0, "shake “it”"};
  record.max_area_change = 1e-12;
  record.energy = step_row(1, 30).energy;
  record.stages = {stage(0), stage(1)};
  for (long step = 7; step <= 30; step += 7)
    record::count_break(break_at(step <= 10 ? 0 : 1, step), record.breaks);
  return record;
}

void SampleRun::play(record::RunObserver& observer, long first, long last, bool finish) {
  observer.begin(model);
  if (const long done = first - 1; done > 0) {
    const int stages = done < 10 ? 0 : done < 30 ? 1 : 2;
    observer.resume({done / 5, done / 10, done, done / 7, done, stages, done != 10 && done < 30});
  }
  int stage_now = -1;
  for (long step = first; step <= last; ++step) {
    const int index = step <= 10 ? 0 : 1;
    if (index != stage_now) {
      stage_now = index;
      record::StageRecord record = stage(index);
      record.steps = step - (index == 0 ? 1 : 11);  // done before: a resumed stage goes on
      record.duration = 0.0;
      observer.stage_begin(index, record);
    }
    if (step % 7 == 0) observer.breaks(break_at(index, step));
    observer.step(step_row(index, step));
    observer.history(history(step));
    if (step % 5 == 0) observer.frame(frame(index, step));
    if (step % 10 == 0) observer.contacts(contacts(index, step, static_cast<int>(step / 10) - 1));
    if (step == 10 || step == 30) observer.stage_end(index, stage(index));
  }
  if (finish) observer.end(run());
}

RunData SampleRun::expected() {
  RunData data{model, run(), false, {}, {}, {}, {}, {}};
  for (long step = 1; step <= 30; ++step) {
    const int index = step <= 10 ? 0 : 1;
    data.steps.push_back(step_row(index, step));
    if (step % 7 == 0) data.breaks.push_back(break_at(index, step));
    data.histories.push_back(history(step));
    if (step % 5 == 0) data.frames.push_back(frame(index, step));
    if (step % 10 == 0) data.contacts.push_back(contacts(index, step, static_cast<int>(step / 10) - 1));
  }
  return data;
}

void expect_equal(const RunData& a, const RunData& b) {
  expect_equal(a.model, b.model);
  expect_equal_rows(a.frames, b.frames, "frames");
  expect_equal_rows(a.contacts, b.contacts, "contacts");
  expect_equal_rows(a.histories, b.histories, "histories");
  expect_equal_rows(a.breaks, b.breaks, "breaks");
  expect_equal_rows(a.run.breaks, b.run.breaks, "counts of breaks");
  expect_equal_rows(a.steps, b.steps, "steps");
  expect_equal_rows(a.run.stages, b.run.stages, "stages");
  EXPECT_EQ(a.run.steps, b.run.steps);
  EXPECT_TRUE(same(a.run.wall_time, b.run.wall_time));
  EXPECT_EQ(a.run.dof, b.run.dof);
  EXPECT_EQ(a.run.state_hash, b.run.state_hash);
  EXPECT_TRUE(same(a.run.open_close.mean_iterations, b.run.open_close.mean_iterations));
  EXPECT_EQ(a.run.open_close.max_iterations, b.run.open_close.max_iterations);
  EXPECT_EQ(a.run.open_close.retried_steps, b.run.open_close.retried_steps);
  EXPECT_EQ(a.run.open_close.unconverged_steps, b.run.open_close.unconverged_steps);
  EXPECT_TRUE(same(a.run.max_overlap.depth, b.run.max_overlap.depth));
  EXPECT_EQ(a.run.max_overlap.block_a, b.run.max_overlap.block_a);
  EXPECT_EQ(a.run.max_overlap.block_b, b.run.max_overlap.block_b);
  EXPECT_EQ(a.run.max_overlap.where, b.run.max_overlap.where);
  EXPECT_EQ(a.run.max_overlap.stage, b.run.max_overlap.stage);
  EXPECT_EQ(a.run.max_overlap.time, b.run.max_overlap.time);
  EXPECT_TRUE(same(a.run.max_area_change, b.run.max_area_change));
  expect_equal(a.run.energy, b.run.energy);
  EXPECT_EQ(a.run.interrupted, b.run.interrupted);
}

}  // namespace keyblock::results
