#include "simulation/build_boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/index.h"
#include "geometry/quadrature.h"

namespace keyblock::simulation {

namespace {

using dynamics::BoundaryPoint;
using dynamics::FarRock;
using dynamics::RockColumn;
using dynamics::RockPlane;

constexpr double springs_over_young = 1000.0;  // 1/m, as of supports
constexpr double alike = 1e-9;                 // of the size of the model: what rounding makes of one height

enum class Side { none, base, left, right, top };

/// Where the sides of the model are, and which edges of blocks lie on them.
class Outside {
 public:
  explicit Outside(const RunSetup& setup) : setup_(setup), box_(boundary_box(setup)) {}

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] double tolerance() const { return alike * std::max(box_.size().x, box_.size().y); }
  template <typename OfEdge>
  void for_edges(std::size_t block, const OfEdge& of_edge) const {
    const Ring& ring = setup_.system.blocks[block].polygon.outer;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
      if (const Side side = side_of(a, b); side != Side::none) of_edge(side, a, b);
    }
  }
  /// The ground beside a side: the highest rock there that is never taken out.
  [[nodiscard]] double ground(Side side) const {
    double highest = box_.min.y;
    for (std::size_t b = 0; b < setup_.system.blocks.size(); ++b) {
      if (setup_.properties[b].fixed || is_excavated(b)) continue;
      for_edges(b, [&](Side of_edge, Vec2 from, Vec2 to) {
        if (of_edge == side) highest = std::max({highest, from.y, to.y});
      });
    }
    return (highest > box_.min.y ? highest : box_.max.y) + setup_.boundary->depth;
  }

 private:
  [[nodiscard]] Side side_of(Vec2 a, Vec2 b) const {
    const auto both = [&](double Vec2::*coordinate, double at) {
      return std::abs(a.*coordinate - at) <= tolerance() && std::abs(b.*coordinate - at) <= tolerance();
    };
    if (both(&Vec2::y, box_.min.y)) return Side::base;
    if (both(&Vec2::x, box_.min.x)) return Side::left;
    if (both(&Vec2::x, box_.max.x)) return Side::right;
    if (both(&Vec2::y, box_.max.y)) return Side::top;
    return Side::none;
  }
  [[nodiscard]] bool is_excavated(std::size_t block) const {
    const std::vector<int>& inside = setup_.system.blocks[block].excavations;
    return std::any_of(setup_.stages.begin(), setup_.stages.end(), [&](const record::Stage& stage) {
      return std::find_first_of(inside.begin(), inside.end(), stage.excavate.begin(), stage.excavate.end()) !=
             inside.end();
    });
  }

  const RunSetup& setup_;
  Box box_;
};

class Builder {
 public:
  Builder(const RunSetup& setup, const dynamics::Model& model)
      : setup_(setup), boundary_(*setup.boundary), model_(model), outside_(setup) {}

  std::shared_ptr<const dynamics::Coupling> build() {
    if (boundary_.sides != record::Sides::roller) add_far_rock();
    for (std::size_t b = 0; b < setup_.system.blocks.size(); ++b) {
      if (!model_.blocks[b].fixed) add_block(b);
    }
    return std::make_shared<dynamics::SeismicBoundary>(std::move(points_), std::move(far_),
                                                       mass_damping(model_));
  }

 private:
  void add_far_rock() {
    const std::optional<Vec2> dashpots =
        boundary_.compliant ? std::optional<Vec2>(boundary_.dashpots) : std::nullopt;
    const auto add = [&](ColumnSide side, double height, double x) {
      std::vector<dynamics::RockPlane> planes;
      for (const FarPlane& plane : boundary_.planes)
        planes.push_back(plane.at_side[side == ColumnSide::left ? 0 : 1]);
      far_.push_back(
          {RockColumn(boundary_.layers_at(side), outside_.box().min.y, height, dashpots, boundary_.fastest,
                      {.viscosity = dynamics::stiffness_damping(model_)}, planes),
           x});
    };
    const double left = outside_.ground(Side::left), right = outside_.ground(Side::right);
    add(ColumnSide::left, left, outside_.box().min.x);
    if (std::abs(left - right) > outside_.tolerance() || !boundary_.right_layers.empty() ||
        !std::ranges::all_of(boundary_.planes, [&](const FarPlane& p) { return is_alike(p); }))
      add(ColumnSide::right, right, outside_.box().max.x);
  }

  /// Both columns would slip alike.
  [[nodiscard]] bool is_alike(const FarPlane& plane) const {
    const auto& [left, right] = plane.at_side;
    return std::abs(left.height - right.height) <= outside_.tolerance() &&
           std::abs(left.dip) + std::abs(right.dip) <= alike;
  }
  void set_far(Side side, BoundaryPoint& p) const {
    if (boundary_.sides != record::Sides::free_field) return;
    p.far = side == Side::right ? static_cast<int>(far_.size()) - 1 : 0;
    p.in_far = far_[at(p.far)].column.place_of(p.place.y);
  }
  /// All of a point that its side says.
  void describe(Side side, double stiffness, BoundaryPoint& p) const {
    const bool takes_waves = boundary_.sides != record::Sides::roller;
    switch (side) {
      case Side::none:
        return;
      case Side::base:
        p.normal = {0.0, -1.0};
        p.springs = {stiffness, stiffness};
        p.absorbs = boundary_.compliant;
        p.dashpots = boundary_.dashpots;
        return;
      case Side::left:
      case Side::right: {
        p.normal = {side == Side::left ? -1.0 : 1.0, 0.0};
        p.springs = {stiffness, 0.0};
        p.absorbs = takes_waves;
        const Vec2 of_rock =
            dynamics::layer_at(boundary_.layers_at(side == Side::left ? ColumnSide::left : ColumnSide::right),
                               p.place.y)
                .impedance();
        p.dashpots = {of_rock.y, of_rock.x};  // pressure goes across a side, shear along it
        set_far(side, p);
        return;
      }
      case Side::top:
        p.normal = {0.0, 1.0};
        p.absorbs = takes_waves;
        p.dashpots = dynamics::layer_at(boundary_.layers, p.place.y).impedance();
        set_far(side, p);
        return;
    }
  }

  void add_block(std::size_t b) {
    const dynamics::Block& block = model_.blocks[b];
    outside_.for_edges(b, [&](Side side, Vec2 from, Vec2 to) {
      if (side == Side::top && !boundary_.overburden) return;
      // As many for every order that the block may come to have: what they remember is theirs.
      const LineRule& rule = gauss_legendre(block.edge_order + 1);
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        BoundaryPoint p;
        p.place = lerp(from, to, rule.points[q]);
        p.length = rule.weights[q] * norm(to - from);
        p.point = {static_cast<int>(b), std::vector<double>(at(block.size))};
        block.basis.evaluate(p.place, p.point.phi.data());
        describe(side, springs_over_young * block.material.young, p);
        const block::Stress s = block::in_situ_at(model_.in_situ, p.place);
        p.traction = {s.xx * p.normal.x + s.xy * p.normal.y, s.xy * p.normal.x + s.yy * p.normal.y};
        points_.push_back(std::move(p));
      }
    });
  }

  const RunSetup& setup_;
  const Boundary& boundary_;
  const dynamics::Model& model_;
  Outside outside_;
  std::vector<FarRock> far_;
  std::vector<BoundaryPoint> points_;
};

}  // namespace

Box boundary_box(const RunSetup& setup) {
  if (setup.has_domain) return setup.domain;
  Box box;
  for (const cutting::CutBlock& block : setup.system.blocks) box.add(bounds(block.polygon));
  return box;
}

std::optional<dynamics::MassDamping> mass_damping(const dynamics::Model& model) {
  const std::optional<dynamics::RayleighDamping>& damping = model.solver.damping;
  if (!damping || damping->mass_rate() == 0.0) return std::nullopt;
  std::vector<dynamics::MassPoint> points;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const dynamics::Block& block = model.blocks[b];
    if (block.fixed) continue;
    // The ground moves about linearly over a block.
    for (const WeightedPoint& p : polygon_rule(block.reference, block.basis.order() + 1)) {
      points.push_back({{static_cast<int>(b), std::vector<double>(at(block.size))}, p.point, p.weight});
      block.basis.evaluate(p.point, points.back().point.phi.data());
    }
  }
  return dynamics::MassDamping(damping->mass_rate(), std::move(points));
}

ColumnHeights column_heights(const RunSetup& setup, ColumnSide side) {
  const Outside outside(setup);
  return {outside.box().min.y, outside.ground(side == ColumnSide::left ? Side::left : Side::right)};
}

std::vector<record::PlaneRecord> planes_beside(const RunSetup& setup, const dynamics::Model& model,
                                               const dynamics::State& state) {
  std::vector<record::PlaneRecord> planes;
  if (!setup.boundary || setup.boundary->planes.empty()) return planes;
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const dynamics::FarField* boundary = model.couplings[k]->far_field();
    if (boundary == nullptr) continue;
    for (std::size_t f = 0; f < boundary->far_rock().size(); ++f) {
      const FarRock& far = boundary->far_rock()[f];
      for (std::size_t j = 0; j < far.column.planes().size(); ++j) {
        const RockPlane& plane = far.column.planes()[j];
        const dynamics::RockPlaneState is = boundary->plane(state.couplings[k], f, j);
        const auto of = std::ranges::find_if(setup.boundary->planes, [&](const FarPlane& p) {
          return std::ranges::any_of(p.at_side,
                                     [&](const RockPlane& side) { return side.height == plane.height; });
        });
        const bool is_known = of != setup.boundary->planes.end();
        planes.push_back({.joint = is_known ? of->joint : "",
                          .x = far.x,
                          .height = plane.height,
                          .dip = plane.dip * 180.0 / std::numbers::pi,
                          .mobilized = is_known ? of->mobilized : 0.0,
                          .normal = is.normal,
                          .shear = is.shear,
                          .slip = is.slip,
                          .slip_max = is.largest_slip,
                          .opened = is.opened});
      }
    }
  }
  return planes;
}

std::shared_ptr<const dynamics::Coupling> build_boundary(const RunSetup& setup,
                                                         const dynamics::Model& model) {
  return Builder(setup, model).build();
}

}  // namespace keyblock::simulation
