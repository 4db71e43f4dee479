#include "simulation/far_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "block/elasticity.h"
#include "simulation/build_boundary.h"
#include "simulation/step_count.h"

namespace keyblock::simulation {

namespace {

using dynamics::RockColumn;
using dynamics::RockPlane;

constexpr double steepest_plane = 10.5 * std::numbers::pi / 180.0;  // 10°, and what cutting makes of it
constexpr double end_stretch = 4.0;  // blocks, over which a joint dips as it does at a side
constexpr double least_mobilized =
    0.5;  // of a plane: what never comes near its strength stays in the compliance
constexpr double across_gap = 0.1,
                 along_gap = 0.6;  // of a block: how far apart pieces of one joint are, across and along
constexpr double straight = 0.98;  // cosine of the turn from a piece to the next

std::string name_of(const RunSetup& setup, cutting::EdgeLabel label) {
  const auto index = static_cast<std::size_t>(label.index);
  if (label.kind == cutting::EdgeKind::joint_set) return setup.joint_set_names[index];
  return label.kind == cutting::EdgeKind::trace_map ? setup.trace_map_names[index] : "joints";
}

/// A joint as it goes on from a side, by its pieces.
struct Course {
  ColumnSide side{};
  std::vector<std::size_t> pieces;
  double height = 0.0, length = 0.0;  ///< m
  double dip = 0.0, end_dip = 0.0;    ///< rad, at both ends
  double end_height = 0.0;
  bool is_through = false;  ///< to the other side
  double mobilized = 0.0;
};

class Finder {
 public:
  Finder(const RunSetup& setup, std::span<const JointPiece> pieces)
      : setup_(setup),
        pieces_(pieces.begin(), pieces.end()),
        box_(boundary_box(setup)),
        size_(mean_block_size(setup)) {
    for (JointPiece& piece : pieces_) {
      if (piece.to.x < piece.from.x) std::swap(piece.from, piece.to);
    }
    for (std::vector<std::size_t>* order : {&by_left_, &by_right_}) {
      order->resize(pieces_.size());
      std::iota(order->begin(), order->end(), std::size_t{0});
    }
    std::ranges::stable_sort(by_left_, {}, [&](std::size_t k) { return pieces_[k].from.x; });
    std::ranges::stable_sort(by_right_, {}, [&](std::size_t k) { return pieces_[k].to.x; });
  }

  FarJoints find() {
    FarJoints found;
    std::vector<Course> courses;
    for (const ColumnSide side : {ColumnSide::left, ColumnSide::right}) add_courses(side, courses);
    for (const ColumnSide side : {ColumnSide::left, ColumnSide::right}) shake(side, courses);
    std::vector<bool> in_plane(pieces_.size(), false);
    for (const Course& course : courses) {
      const bool is_plane = course.is_through && std::abs(course.dip) <= steepest_plane &&
                            std::abs(course.end_dip) <= steepest_plane;
      const bool ends_above =
          course.side == ColumnSide::right &&
          course.end_height >= column_heights(setup_, ColumnSide::left).ground - across_gap * size_;
      if (!is_plane || ends_above) {
        hold(course, found.held);
      } else if (course.side == ColumnSide::left && course.mobilized >= least_mobilized) {
        for (const std::size_t k : course.pieces) in_plane[k] = true;
        found.planes.push_back(plane_of(course));
      }
    }
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (!in_plane[k]) found.others.push_back(pieces_[k]);
    }
    return found;
  }

 private:
  [[nodiscard]] double side_x(ColumnSide side) const {
    return side == ColumnSide::left ? box_.min.x : box_.max.x;
  }
  /// rad; what cutting makes of a level joint is level.
  [[nodiscard]] static double dip_of(Vec2 way) {
    constexpr double rounding = 1e-3;
    const double dip = -std::atan2(way.y, way.x);
    return std::abs(dip) < rounding ? 0.0 : dip;
  }

  void add_courses(ColumnSide side, std::vector<Course>& courses) const {
    const bool left = side == ColumnSide::left;
    const double top = column_heights(setup_, side).ground;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const Vec2 start = left ? pieces_[k].from : pieces_[k].to;
      const bool meets = std::abs(start.x - side_x(side)) <= 1e-6 * box_.size().x &&
                         std::abs((left ? pieces_[k].to : pieces_[k].from).x - start.x) > across_gap * size_;
      if (meets && start.y > box_.min.y + across_gap * size_ && start.y < top - across_gap * size_)
        courses.push_back(follow(side, k));
    }
  }

  // Of a piece on the way inwards from a side.
  [[nodiscard]] Vec2 begin(ColumnSide side, std::size_t k) const {
    return side == ColumnSide::left ? pieces_[k].from : pieces_[k].to;
  }
  [[nodiscard]] Vec2 end(ColumnSide side, std::size_t k) const {
    return side == ColumnSide::left ? pieces_[k].to : pieces_[k].from;
  }
  [[nodiscard]] Vec2 way(ColumnSide side, std::size_t k) const {
    const Vec2 along = end(side, k) - begin(side, k);
    return along / norm(along);
  }

  /// The piece by which the joint of another goes on.
  [[nodiscard]] std::optional<std::size_t> next(ColumnSide side, std::size_t last) const {
    std::optional<std::size_t> found;
    double nearest = along_gap * size_;
    const Vec2 from = end(side, last), along = way(side, last);
    const auto& order = side == ColumnSide::left ? by_left_ : by_right_;
    const auto begin_x = [&](std::size_t k) { return begin(side, k).x; };
    auto candidate = std::ranges::lower_bound(order, from.x - nearest, {}, begin_x);
    for (; candidate != order.end() && begin_x(*candidate) <= from.x + along_gap * size_; ++candidate) {
      const std::size_t k = *candidate;
      const Vec2 gap = begin(side, k) - from;
      if (!(pieces_[k].label == pieces_[last].label) || k == last || norm(gap) > nearest ||
          std::abs(cross(along, gap)) > across_gap * size_ || dot(along, way(side, k)) < straight ||
          dot(along, end(side, k) - from) <= 0.0)
        continue;
      nearest = norm(gap);
      found = k;
    }
    return found;
  }

  /// From a piece at a side inwards, from piece to piece of the same joint.
  [[nodiscard]] Course follow(ColumnSide side, std::size_t first) const {
    Course course{.side = side, .pieces = {first}, .height = begin(side, first).y};
    for (auto k = next(side, first); k; k = next(side, *k)) course.pieces.push_back(*k);
    const Vec2 start = begin(side, first), stop = end(side, course.pieces.back());
    course.end_height = stop.y;
    course.length = norm(stop - start);
    course.is_through = std::abs(stop.x - start.x) >= (1.0 - 1e-6) * box_.size().x;
    const double stretch = 0.999 * std::min(course.length, end_stretch * size_);
    const auto near_start = std::ranges::find_if(
        course.pieces, [&](std::size_t k) { return norm(end(side, k) - start) >= stretch; });
    const auto near_end = std::find_if(course.pieces.rbegin(), course.pieces.rend(),
                                       [&](std::size_t k) { return norm(stop - begin(side, k)) >= stretch; });
    const double to_right = side == ColumnSide::left ? 1.0 : -1.0;
    course.dip = dip_of(to_right * (end(side, *near_start) - start));
    course.end_dip = dip_of(to_right * (stop - begin(side, *near_end)));
    return course;
  }

  /// What a joint of a course is in the rock beside a side.
  [[nodiscard]] RockPlane plane_at(const Course& course, ColumnSide side) const {
    const JointPiece& piece = pieces_[course.pieces.front()];
    const contact::JointProperties& joint = joint_of(setup_.joints, piece.label);
    const bool is_start = side == course.side;
    RockPlane plane{.height = is_start ? course.height : course.end_height,
                    .dip = is_start ? course.dip : course.end_dip,
                    .friction = std::tan(joint.friction * std::numbers::pi / 180.0),
                    .cohesion = joint.cohesion,
                    .tension = joint.tension};
    plane.normal_stiffness = joint.normal_stiffness.value_or(
        setup_.solver.penalty *
        std::min(setup_.properties[piece.a].material.young, setup_.properties[piece.b].material.young));
    plane.shear_stiffness = joint.stiffness_ratio * plane.normal_stiffness;
    const auto& layers = setup_.boundary->layers_at(side);
    double pressure = 0.0, high = column_heights(setup_, side).ground;
    const double g = -setup_.gravity.y;
    for (std::size_t k = 0; k < layers.size(); ++k) {
      const double low = std::max(plane.height, k + 1 < layers.size() ? layers[k + 1].top : plane.height);
      if (low >= high) continue;
      pressure += layers[k].density * g * (high - low);
      high = low;
    }
    const block::Stress top = block::in_situ_at(setup_.in_situ, box_.max),
                        here = block::in_situ_at(setup_.in_situ, Vec2{side_x(side), plane.height});
    if (setup_.boundary->overburden && setup_.boundary->depth == 0.0) pressure -= top.yy;
    const dynamics::RockLayer& rock = dynamics::layer_at(layers, plane.height);
    const double xx = setup_.in_situ ? here.xx : -pressure * rock.sideways / rock.upright,
                 s = std::sin(plane.dip), c = std::cos(plane.dip);
    plane.level = pressure;
    plane.normal = pressure * c * c - xx * s * s - 2.0 * s * c * here.xy;
    plane.shear = s * c * (xx + pressure) + (c * c - s * s) * here.xy;
    return plane;
  }

  [[nodiscard]] FarPlane plane_of(const Course& course) const {
    return {name_of(setup_, pieces_[course.pieces.front()].label),
            {plane_at(course, ColumnSide::left), plane_at(course, ColumnSide::right)},
            course.mobilized};
  }

  /// The column of a side under all motions, without planes.
  void shake(ColumnSide side, std::vector<Course>& courses) const {
    const Boundary& boundary = *setup_.boundary;
    const ColumnHeights heights = column_heights(setup_, side);
    const RockColumn column(boundary.layers_at(side), heights.base, heights.ground,
                            boundary.compliant ? std::optional(boundary.dashpots) : std::nullopt,
                            boundary.fastest, {.viscosity = setup_.solver.stiffness_time()});
    struct Watched {
      Course* course;
      RockPlane plane;
      RockColumn::Place place;
    };
    std::vector<Watched> watched;
    for (Course& course : courses) {
      if (course.side != side) continue;
      const RockPlane plane = plane_at(course, side);
      watched.push_back({&course, plane, column.place_of(plane.height)});
    }
    if (watched.empty()) return;
    const auto rule = dynamics::Integrator::of(setup_.solver);
    for (const record::Stage& stage : setup_.stages) {
      if (stage.kind != record::StageKind::shake) continue;
      const loading::GroundMotion& motion = setup_.motions.at(static_cast<std::size_t>(stage.motion));
      std::vector<double> memory(column.memory_size(), 0.0);
      const double dt = setup_.time_step, steps = step_count(stage.duration.value_or(motion.duration()), dt);
      for (double k = 0.0; k < steps; ++k) {
        std::vector<double> after(memory.size());
        column.step(memory, dt, rule, stage.scale * motion.mean(k * dt, (k + 1.0) * dt), after);
        const std::vector<double> strained = column.strained(memory, dt, after);
        for (const Watched& w : watched)
          w.course->mobilized =
              std::max(w.course->mobilized, mobilized(w.plane, column.stress(strained, w.place)));
        memory = std::move(after);
      }
    }
  }

  /// Shear over strength on a joint, with what waves add; an open joint has none, and is as much as mobilized.
  static double mobilized(const RockPlane& plane, const RockColumn::Stress& wave) {
    const double s = std::sin(plane.dip), c = std::cos(plane.dip),
                 normal = plane.normal - wave.xx * s * s - wave.yy * c * c - 2.0 * s * c * wave.xy,
                 shear = plane.shear + s * c * (wave.xx - wave.yy) + (c * c - s * s) * wave.xy,
                 strength = plane.cohesion + plane.friction * std::max(normal, 0.0);
    if (normal <= -plane.tension) return HUGE_VAL;
    return shear == 0.0 ? 0.0 : strength > 0.0 ? std::abs(shear) / strength : HUGE_VAL;
  }

  void hold(const Course& course, std::vector<HeldJoint>& held) const {
    if (course.length < 0.5 * std::min(box_.size().x, box_.size().y)) return;
    const HeldJoint joint{name_of(setup_, pieces_[course.pieces.front()].label),
                          course.side,
                          course.height,
                          course.dip * 180.0 / std::numbers::pi,
                          course.length,
                          course.mobilized};
    const auto known = std::ranges::find(held, joint.joint, &HeldJoint::joint);
    if (known == held.end())
      held.push_back(joint);
    else if (joint.mobilized > known->mobilized)
      *known = joint;
  }

  const RunSetup& setup_;
  std::vector<JointPiece> pieces_;
  std::vector<std::size_t> by_left_, by_right_;  ///< pieces in the order of their ends
  Box box_;
  double size_;
};

}  // namespace

FarJoints far_joints(const RunSetup& setup, std::span<const JointPiece> pieces) {
  if (setup.boundary->sides != record::Sides::free_field) return {{}, {}, {pieces.begin(), pieces.end()}};
  return Finder(setup, pieces).find();
}

}  // namespace keyblock::simulation
