#include "synthetic_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synthetic_damage.h"

namespace keyblock::made_up {

namespace {

using cutting::EdgeKind;
using cutting::EdgeLabel;
using record::BlockStatus;
using record::ContactState;
using record::StageKind;

constexpr double brick_width = 1.0, brick_height = 0.6, gravity = 9.81;

/// How a brick moves.
struct Motion {
  double fall_start = HUGE_VAL;  ///< s
  double drop = 0.0;             ///< m, until it lands
  double spin = 0.0;             ///< rad when landed
  double loosening = 0.0;        ///< m, sag at the end of the shaking
};

struct StagePlan {
  const char* name;
  StageKind kind;
  double start, duration;
  double pga;
};

class Wall {
 public:
  explicit Wall(const SyntheticOptions& options) : options_(options) {
    width_ = options.columns * brick_width;
    height_ = options.rows * brick_height;
    opening_ = {
        {std::round(0.35 * options.columns) * brick_width, 3 * brick_height},
        {std::round(0.65 * options.columns) * brick_width, std::round(0.6 * options.rows) * brick_height}};
    plan_ = {{"in situ", StageKind::settle, 0.0, 0.0, 0.0},
             {options.excavation ? "excavated" : "loaded", StageKind::settle, 0.0, 0.0, 0.0},
             {"first earthquake", StageKind::shake, 0.0, options.shake_duration, 2.31},
             {"after", StageKind::rest, options.shake_duration, 2.0, 0.0}};
    for (const StagePlan& stage : plan_) run_.model.stage_names.emplace_back(stage.name);
    if (options.interrupted) plan_.pop_back();
  }

  results::RunData build() {
    add_model();
    add_stages();
    for (std::size_t k = 0; k < plan_.size(); ++k)
      if (options_.frames) add_frames(static_cast<int>(k));
    add_rows();
    return std::move(run_);
  }

 private:
  void add_model() {
    record::ModelRecord& model = run_.model;
    model.title = "Brick wall <synthetic> & shaken";
    model.version = "0.1.0";
    model.seed = 18446744073709551615ULL;
    model.realization = 3;
    model.step_size = 0.002;
    model.scenario =
        "title = \"Brick wall <synthetic> & shaken\"\n# </script><b>not markup</b>\n[time]\nstep = 0.002\n";
    model.slip_limit = model.opening_limit = 0.001;
    model.joint_set_names = {"bed joints", "head joints"};
    model.history_names = {"crown", "springline"};
    model.ground = synthetic_ground();
    model.cutting.traces = 412;
    model.cutting.joints_used = 231;
    model.cutting.trace_length = 618.4;
    model.cutting.removed_length = 143.2;
    model.cutting.removed_pieces = 305;
    model.cutting.merged_slivers = 7;
    model.cutting.merged_vertices = 19;
    model.cutting.domain_area = width_ * height_;
    model.cutting.sliver_area = 0.0123;
    model.cutting.merged_across_joints = 3;
    model.cutting.highest_tooth = 0.012;
    model.cutting.slivers_left = 1;
    if (options_.excavation) {
      model.opening_width = opening_.size().x;
      model.excavation_names = {"tunnel"};
      model.excavation_outlines = {
          {opening_.min, {opening_.max.x, opening_.min.y}, opening_.max, {opening_.min.x, opening_.max.y}}};
    }
    for (int row = 0; row < options_.rows; ++row) {
      const bool shifted = row % 2 == 1;
      const int bricks = options_.columns + (shifted ? 1 : 0);
      for (int column = 0; column < bricks; ++column) {
        const double left = std::max(0.0, (column - (shifted ? 0.5 : 0.0)) * brick_width);
        const double right = std::min(width_, (column + (shifted ? 0.5 : 1.0)) * brick_width);
        add_brick({{left, row * brick_height}, {right, (row + 1) * brick_height}});
      }
    }
    const double t = 0.5;
    add_frame_block("frame bottom", {{-t, -t}, {width_ + t, 0.0}});
    add_frame_block("frame right", {{width_, 0.0}, {width_ + t, height_}});
    add_frame_block("frame left", {{-t, 0.0}, {0.0, height_}});
  }

  void add_brick(const Box& box) {
    record::ModelRecord::Block block;
    const Vec2 centre = 0.5 * (box.min + box.max);
    block.centroid = centre;
    block.area = box.size().x * box.size().y;
    block.density = 2270.0;
    const auto index = static_cast<int>(run_.model.blocks.size());
    // One brick of second order, which bends: beside the opening, so that it stays.
    const bool bends =
        box.min.y < 0.5 * height_ && box.max.y > 0.5 * height_ && box.min.x < 1.2 && box.max.x > 1.2;
    if (bends) {
      block.order = 2;
      block.name = "bent brick";
    }
    const bool inside = options_.excavation && opening_.contains(centre);
    if (inside) block.excavations = {0};
    boxes_.push_back(box);
    bends_.push_back(bends);
    motions_.push_back(motion_of(index, box, inside));
    add_ring(block, box, bends ? 8 : options_.edge_pieces);
  }

  Motion motion_of(int index, const Box& box, bool inside) {
    Motion motion;
    const Vec2 centre = 0.5 * (box.min + box.max);
    const double above = centre.y - opening_.max.y;
    const double off = std::abs(centre.x - 0.5 * (opening_.min.x + opening_.max.x));
    if (!options_.excavation || inside || above < 0.0) return motion;
    const double wedge = 0.5 * opening_.size().x - 1.1 * above;
    if (off < wedge - 0.6) {
      const double layer = std::floor(above / brick_height);
      motion.fall_start = 1.5 + 2.2 * layer + 0.13 * (index % 5);
      motion.drop = opening_.size().y;
      motion.spin = 0.15 * ((index % 3) - 1);
    } else if (off < wedge + 1.0) {
      motion.loosening = 0.012 + 0.004 * (index % 4);
    }
    return motion;
  }

  void add_frame_block(const char* name, const Box& box) {
    record::ModelRecord::Block block;
    block.name = name;
    block.fixed = true;
    block.area = box.size().x * box.size().y;
    block.density = 2270.0;
    block.centroid = 0.5 * (box.min + box.max);
    boxes_.push_back(box);
    bends_.push_back(false);
    motions_.emplace_back();
    add_ring(block, box, 1);
  }

  void add_ring(record::ModelRecord::Block& block, const Box& box, int pieces) {
    record::ModelRecord& model = run_.model;
    const Vec2 corners[] = {box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}};
    block.ring_start = {static_cast<int>(model.vertices.size())};
    for (int side = 0; side < 4; ++side) {
      const Vec2 from = corners[side];
      const Vec2 to = corners[(side + 1) % 4];
      const Vec2 middle = 0.5 * (from + to);
      EdgeLabel label{EdgeKind::joint_set, static_cast<std::int16_t>(side % 2)};
      if (middle.x <= 0.0 || middle.x >= width_ || middle.y <= 0.0 || middle.y >= height_)
        label = {EdgeKind::domain, 0};
      for (int k = 0; k < pieces; ++k) {
        model.vertices.push_back(lerp(from, to, double(k) / pieces));
        model.edge_label.push_back(label);
        block_of_.push_back(static_cast<int>(boxes_.size()) - 1);
      }
    }
    block.ring_start.push_back(static_cast<int>(model.vertices.size()));
    model.blocks.push_back(block);
  }

  /// Share of the settling that is done: 1 once `stage` has ended.
  [[nodiscard]] Vec2 displacement(std::size_t v, int stage, double share, double time) const {
    const auto b = static_cast<std::size_t>(block_of_[v]);
    const record::ModelRecord::Block& block = run_.model.blocks[b];
    if (block.fixed) return {};
    const Vec2 x = run_.model.vertices[v];
    const double settled = stage == 0 ? share : 1.0;
    Vec2 u{0.0, -0.0015 * settled * (x.y / height_) * (2.0 - x.y / height_)};
    if (stage >= 1 && options_.excavation) {
      const double opened = stage == 1 ? share : 1.0;
      const Vec2 towards = 0.5 * (opening_.min + opening_.max) - x;
      u += 0.004 * opened / (1.0 + squared_norm(towards)) * towards;
    }
    const Motion& motion = motions_[b];
    if (stage >= 2) {
      const double shaken = std::min(1.0, time / options_.shake_duration);
      const double wobble =
          time < options_.shake_duration ? std::sin(9.0 * time) * std::sin(0.3 * time) : 0.0;
      u += {0.003 * wobble * x.y / height_, -motion.loosening * shaken};
      const double fallen =
          time > motion.fall_start ? 0.5 * gravity * std::pow(time - motion.fall_start, 2) : 0.0;
      const double way = std::min(fallen, motion.drop);
      const double angle = motion.drop > 0.0 ? motion.spin * way / motion.drop : 0.0;
      const Vec2 arm = x - block.centroid;
      u += {arm.x * (std::cos(angle) - 1.0) - arm.y * std::sin(angle),
            arm.x * std::sin(angle) + arm.y * (std::cos(angle) - 1.0) - way};
      if (bends_[b]) u += {0.0, -0.12 * shaken * (0.25 - std::pow(arm.x / brick_width, 2))};
    }
    return u;
  }

  [[nodiscard]] BlockStatus status(std::size_t b, int stage, double time) const {
    const Motion& motion = motions_[b];
    if (!run_.model.blocks[b].excavations.empty() && stage >= 1) return BlockStatus::excavated;
    if (stage >= 2 && time > motion.fall_start + 0.3) return BlockStatus::fallen;
    if (stage >= 2 && motion.loosening * std::min(1.0, time / options_.shake_duration) > 0.01)
      return BlockStatus::loosened;
    return BlockStatus::in_place;
  }

  void add_frames(int stage) {
    const StagePlan& plan = plan_[static_cast<std::size_t>(stage)];
    const int count = options_.frames_per_stage;
    const bool cut = options_.interrupted && stage + 1 == static_cast<int>(plan_.size());
    for (int k = 0; k < count; ++k) {
      const double share = (cut ? 0.6 : 1.0) * k / (count - 1);
      record::Frame frame;
      frame.stage = stage;
      frame.time = plan.start + share * plan.duration;
      frame.step = step_of(stage, share);
      for (std::size_t v = 0; v < run_.model.vertices.size(); ++v) {
        const Vec2 u = displacement(v, stage, share, frame.time);
        frame.displacement.push_back({static_cast<float>(u.x), static_cast<float>(u.y)});
      }
      for (std::size_t b = 0; b < run_.model.blocks.size(); ++b) {
        frame.status.push_back(status(b, stage, frame.time));
        frame.stress.push_back(stress(b, frame.status.back()));
        frame.order.push_back(static_cast<std::int16_t>(run_.model.blocks[b].order));
      }
      if (k == 0 || k == count - 1 || (plan.duration > 0.0 && k % 3 == 0)) add_contacts(frame);
      run_.frames.push_back(std::move(frame));
    }
  }

  [[nodiscard]] std::array<float, 3> stress(std::size_t b, BlockStatus status) const {
    if (run_.model.blocks[b].fixed || status == BlockStatus::fallen || status == BlockStatus::excavated)
      return {};
    const Vec2 c = run_.model.blocks[b].centroid;
    const double vertical = -2270.0 * gravity * (height_ - c.y);
    const double beside = std::exp(-squared_norm(c - 0.5 * (opening_.min + opening_.max)) / 8.0);
    return {static_cast<float>(0.4 * vertical * (1.0 - beside)),
            static_cast<float>(vertical * (1.0 + beside)),
            static_cast<float>(-4000.0 * beside * (c.x - 0.5 * width_))};
  }

  void add_contacts(const record::Frame& frame) {
    record::ContactFrame snapshot{frame.time, frame.stage, {}, frame.step};
    for (std::size_t a = 0; a < boxes_.size(); ++a) {
      if (run_.model.blocks[a].fixed || frame.status[a] == BlockStatus::excavated) continue;
      for (std::size_t b = 0; b < boxes_.size(); ++b) {
        const double overlap =
            std::min(boxes_[a].max.x, boxes_[b].max.x) - std::max(boxes_[a].min.x, boxes_[b].min.x);
        const bool under = std::abs(boxes_[b].max.y - boxes_[a].min.y) < 1e-9 && overlap > 1e-9;
        if (!under || a == b || frame.status[b] == BlockStatus::excavated) continue;
        for (const bool right : {false, true})
          snapshot.contacts.push_back(contact(a, b, right, overlap, frame));
      }
    }
    run_.contacts.push_back(std::move(snapshot));
  }

  [[nodiscard]] record::ContactRecord contact(std::size_t a, std::size_t b, bool right, double overlap,
                                              const record::Frame& frame) const {
    const double edge =
        right ? std::min(boxes_[a].max.x, boxes_[b].max.x) : std::max(boxes_[a].min.x, boxes_[b].min.x);
    const auto first = static_cast<std::size_t>(run_.model.blocks[b].ring_start[0]);
    record::ContactRecord record;
    record.block_a = static_cast<int>(a);
    record.block_b = static_cast<int>(b);
    record.position = Vec2{edge, boxes_[b].max.y} +
                      Vec2{double{frame.displacement[first][0]}, double{frame.displacement[first][1]}};
    record.normal = {0.0, 1.0};
    record.length = 0.5 * overlap;
    const double shaken = frame.stage >= 2 ? std::min(1.0, frame.time / options_.shake_duration) : 0.02;
    const Vec2 from_opening = record.position - 0.5 * (opening_.min + opening_.max);
    record.shear_displacement =
        0.02 * shaken * std::exp(-squared_norm(from_opening) / 9.0) * (a % 2 == 0 ? 1.0 : -1.0);
    const bool apart = frame.status[a] == BlockStatus::fallen || frame.status[b] == BlockStatus::fallen;
    record.state = apart                   ? ContactState::open
                   : record.slip() > 0.002 ? ContactState::sliding
                                           : ContactState::locked;
    record.gap = apart ? 0.3 : -2e-5;
    record.normal_force = apart ? 0.0 : 2.0e4;
    record.label = {EdgeKind::joint_set, 0};
    return record;
  }

  [[nodiscard]] static long step_of(int stage, double share) {
    constexpr long steps[] = {800, 1200, 5000, 1000};
    long before = 0;
    for (int k = 0; k < stage; ++k) before += steps[k];
    return before + std::lround(share * static_cast<double>(steps[stage]));
  }

  void add_stages() {
    record::RunRecord& record = run_.run;
    for (std::size_t k = 0; k < plan_.size(); ++k) {
      const StagePlan& plan = plan_[k];
      const bool cut = options_.interrupted && k + 1 == plan_.size();
      record::StageRecord stage;
      stage.stage.name = plan.name;
      stage.stage.kind = plan.kind;
      if (k == 1 && options_.excavation) stage.stage.excavate = {0};
      stage.interrupted = cut;
      stage.steps = step_of(static_cast<int>(k), cut ? 0.6 : 1.0) - step_of(static_cast<int>(k), 0.0);
      stage.start_time = plan.start;
      stage.duration = (cut ? 0.6 : 1.0) * plan.duration;
      if (plan.kind != StageKind::settle) stage.planned_duration = plan.duration;
      stage.pga = plan.pga;
      stage.wall_time = 1.3e-3 * static_cast<double>(stage.steps);
      stage.equilibrium_reached = plan.kind == StageKind::settle && !(options_.marginal && k == 1);
      stage.worst_residual_ratio = plan.kind == StageKind::settle ? 0.0083 : 0.0;
      if (options_.marginal && k == 0) stage.moving = {{120, 0.97, 120}};
      if (options_.marginal && k == 1) stage.moving = {{120, 0.62, 120}, {121, 0.0, 121}, {137, 0.35, 137}};
      if (options_.excavation) {
        stage.fallen = fallen_at(k);
        stage.damage = damage_at(k);
      } else {
        stage.damage.slip_max = stage.damage.slip_max_ever = 1e-3 * static_cast<double>(k);
        stage.damage.largest_block_pressure = stage.damage.fallen_depth = std::nan("");
        stage.damage.rotation_max = 0.03 * static_cast<double>(k);
        stage.damage.hinges = k < 2 ? 0 : 4;
        stage.standing = record::Standing::stands;
      }
      if (plan.kind == StageKind::shake) add_motion(stage);
      record.steps += stage.steps;
      record.wall_time += stage.wall_time;
      record.stages.push_back(std::move(stage));
    }
    record.dof = 6 * static_cast<int>(run_.model.blocks.size() - 3) + 6;
    record.state_hash = "9f2c44d1a07be863";
    record.interrupted = options_.interrupted;
    record.open_close = {1.62, 14, 3, options_.marginal ? 2 : 0};
    record.max_overlap = {options_.marginal ? 2.4e-3 : 8.7e-5, 3, 7, {0.5, 0.5}, 1.5, "shake"};
    record.max_area_change = 3.2e-5;
    record.energy.residual_ratio = 0.0021;
  }

  [[nodiscard]] std::vector<record::FallenBlock> fallen_at(std::size_t stage) const {
    std::vector<record::FallenBlock> fallen;
    for (std::size_t b = 0; stage >= 2 && b < boxes_.size(); ++b) {
      if (status(b, 2, options_.shake_duration) != BlockStatus::fallen) continue;
      const auto& block = run_.model.blocks[b];
      fallen.push_back({static_cast<int>(b), block.area, block.area * block.density * gravity,
                        boxes_[b].max.y - opening_.max.y, record::WallPart::crown});
    }
    return fallen;
  }

  [[nodiscard]] record::Damage damage_at(std::size_t stage) const {
    double loosened = 0.0;
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      if (status(b, 2, options_.shake_duration) == BlockStatus::loosened)
        loosened += run_.model.blocks[b].area;
    }
    return synthetic_damage(stage, fallen_at(stage), loosened, opening_.size());
  }

  void add_motion(record::StageRecord& stage) const {
    const int n = 1000;
    for (int i = 0; i <= n; ++i) {
      const double t = options_.shake_duration * i / n;
      stage.motion_time.push_back(t);
      stage.motion.push_back(acceleration(t));
    }
  }

  [[nodiscard]] Vec2 acceleration(double t) const {
    const double envelope = std::sin(std::numbers::pi * t / options_.shake_duration);
    return {2.3 * envelope * std::sin(12.0 * t) * std::cos(1.7 * t),
            1.1 * envelope * std::sin(19.0 * t + 1.0)};
  }

  void add_rows() {
    const std::size_t stages = plan_.size();
    double friction = 0.0, input = 0.0;
    for (std::size_t k = 0; k < stages; ++k) {
      const bool cut = options_.interrupted && k + 1 == stages;
      const long steps = step_of(static_cast<int>(k), cut ? 0.6 : 1.0) - step_of(static_cast<int>(k), 0.0);
      for (long i = 0; i < steps; i += 5) {
        const double share = static_cast<double>(i) / static_cast<double>(steps);
        record::StepRow row;
        row.stage = static_cast<int>(k);
        row.step = step_of(static_cast<int>(k), 0.0) + i;
        row.time = plan_[k].start + share * plan_[k].duration;
        const double busy = plan_[k].kind == StageKind::shake ? std::sin(std::numbers::pi * share) : 0.1;
        row.iterations =
            1 + static_cast<int>(3.0 * busy * (1.0 + std::sin(0.37 * double(i)))) + (i % 977 == 0 ? 7 : 0);
        row.step_size = 0.002;
        row.penetration = 2e-5 * (1.0 + busy);
        row.max_displacement = 1e-6 + 0.02 * busy;
        row.closed_contacts = 700 - static_cast<int>(80.0 * busy);
        friction += 8.0 * busy;
        input += 10.0 * busy;
        row.energy = {.kinetic = 500.0 * busy,
                      .strain = 3000.0,
                      .gravity = -0.3 * friction,
                      .contact = 800.0,
                      .friction = friction,
                      .damping = 0.05 * friction,
                      .input = input,
                      .numerical = 0.1 * friction,
                      .residual_ratio = 0.001 * share};
        run_.steps.push_back(row);
        record::HistoryRow history;
        history.time = row.time;
        history.step = row.step;
        for (const double height : {1.0, 0.4}) {
          const Vec2 a = plan_[k].kind == StageKind::shake ? acceleration(row.time) : Vec2{};
          history.points.push_back({1e-3 * height * a.x, -1.5e-3 * height + 1e-4 * a.y, 0.02 * a.x,
                                    0.01 * a.y, -3.0e4 * height, -9.0e4 * height + 4e3 * a.y, 2e3 * a.x,
                                    height * a.x, height * a.y});
        }
        run_.histories.push_back(std::move(history));
      }
    }
  }

  SyntheticOptions options_;
  double width_ = 0.0, height_ = 0.0;
  Box opening_;
  std::vector<StagePlan> plan_;
  results::RunData run_;
  std::vector<Box> boxes_;
  std::vector<bool> bends_;
  std::vector<Motion> motions_;
  std::vector<int> block_of_;  ///< of every display vertex
};

}  // namespace

results::RunData synthetic_run(const SyntheticOptions& options) {
  return Wall(options).build();
}

}  // namespace keyblock::made_up
