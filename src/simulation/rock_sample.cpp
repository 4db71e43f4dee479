#include "simulation/rock_sample.h"

#include <algorithm>
#include <cmath>

#include "cutting/interfaces.h"
#include "geometry/facing.h"

namespace keyblock::simulation {

namespace {

constexpr double touching = 1e-3;  // of the block size, that facing edges are apart at most

struct Edge {
  std::size_t block;
  Vec2 from, to;
  cutting::EdgeLabel label;
  [[nodiscard]] double left() const { return std::min(from.x, to.x); }
  [[nodiscard]] double right() const { return std::max(from.x, to.x); }
};

bool is_joint(cutting::EdgeLabel label) {
  return label.kind == cutting::EdgeKind::joint_set || label.kind == cutting::EdgeKind::trace_map;
}

std::vector<Edge> edges_of(const cutting::BlockSystem& system) {
  std::vector<Edge> edges;
  for (std::size_t b = 0; b < system.blocks.size(); ++b) {
    const cutting::CutBlock& block = system.blocks[b];
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const cutting::EdgeLabel label = block.labels.empty() ? cutting::EdgeLabel{} : block.labels[r][k];
        if (label.kind == cutting::EdgeKind::excavation || label.kind == cutting::EdgeKind::domain) continue;
        edges.push_back({b, ring[k], ring[(k + 1) % ring.size()], label});
      }
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.left() < b.left(); });
  return edges;
}

/// Where two edges face each other.
std::optional<JointPiece> piece_of(const Edge& a, const Edge& b, double tolerance) {
  const auto common = facing_stretch(a.from, a.to, b.from, b.to, tolerance);
  if (!common) return std::nullopt;
  const Vec2 along = (a.to - a.from) / norm(a.to - a.from);
  return JointPiece{a.block, b.block, a.from + common->from * along, a.from + common->to * along,
                    is_joint(a.label) ? a.label : b.label};
}

/// Of a ring, what lies on one side of a line across an axis.
Ring cut_off(const Ring& ring, double Vec2::*axis, double at, double sign) {
  Ring left;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
    const double before = sign * (a.*axis - at), after = sign * (b.*axis - at);
    if (before >= 0.0) left.push_back(a);
    if ((before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0))
      left.push_back(lerp(a, b, before / (before - after)));
  }
  return left;
}

double area_inside(const Polygon& polygon, const Box& part) {
  const Box all = bounds(polygon);
  if (all.max.x <= part.min.x || all.min.x >= part.max.x || all.max.y <= part.min.y ||
      all.min.y >= part.max.y)
    return 0.0;
  double sum = 0.0;
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    Ring ring = cut_off(polygon.ring(r), &Vec2::x, part.min.x, 1.0);
    ring = cut_off(ring, &Vec2::x, part.max.x, -1.0);
    ring = cut_off(ring, &Vec2::y, part.min.y, 1.0);
    ring = cut_off(ring, &Vec2::y, part.max.y, -1.0);
    if (ring.size() > 2) sum += signed_area(ring);
  }
  return sum;
}

/// m of a stretch; half of one that lies on the border.
double length_inside(Vec2 from, Vec2 to, const Box& part, double tolerance) {
  double begin = 0.0, end = 1.0, share = 1.0;
  const auto clip = [&](double Vec2::*axis) {
    const double a = from.*axis, b = to.*axis, low = part.min.*axis, high = part.max.*axis;
    if (std::abs(b - a) <= tolerance) {
      const double middle = 0.5 * (a + b);
      if (middle < low - tolerance || middle > high + tolerance) share = 0.0;
      if (std::abs(middle - low) <= tolerance || std::abs(middle - high) <= tolerance) share *= 0.5;
      return;
    }
    const double at_low = (low - a) / (b - a), at_high = (high - a) / (b - a);
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  };
  clip(&Vec2::x);
  clip(&Vec2::y);
  return end > begin ? share * (end - begin) * norm(to - from) : 0.0;
}

}  // namespace

double mean_block_size(const RunSetup& setup) {
  return cutting::mean_block_size(setup.system);
}

std::vector<JointPiece> joint_pieces(const RunSetup& setup) {
  const std::vector<Edge> edges = edges_of(setup.system);
  const double tolerance = touching * mean_block_size(setup);
  std::vector<JointPiece> pieces;
  std::vector<std::size_t> reached;  // edges that go on as far as the one at hand
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Edge& edge = edges[k];
    std::erase_if(reached, [&](std::size_t i) { return edges[i].right() < edge.left() - tolerance; });
    for (const std::size_t i : reached) {
      if (edges[i].block == edge.block) continue;
      auto piece = piece_of(edge, edges[i], tolerance);
      if (!piece) continue;
      piece->label = cutting::joint_between(setup.system, piece->a, piece->b).value_or(piece->label);
      pieces.push_back(*piece);
    }
    reached.push_back(k);
  }
  return pieces;
}

const contact::JointProperties& joint_of(const JointTable& joints, cutting::EdgeLabel label) {
  const auto index = static_cast<std::size_t>(label.index);
  if (const int place = joints.place_of_trace(label); place >= 0)
    return joints.of_traces[static_cast<std::size_t>(place)].joint;
  if (label.kind == cutting::EdgeKind::joint_set) return joints.joint_sets[index];
  return label.kind == cutting::EdgeKind::trace_map ? joints.trace_maps[index] : joints.standard;
}

RockSample::RockSample(const RunSetup& setup, std::span<const JointPiece> pieces, const Box& part)
    : whole_(part.size().x * part.size().y) {
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    const double inside = area_inside(setup.system.blocks[b].polygon, part);
    filled_ += inside;
    if (inside > 0.0 && !setup.properties[b].fixed) add_block(setup.properties[b].material, inside);
  }
  const double tolerance = touching * mean_block_size(setup);
  for (const JointPiece& piece : pieces) {
    const BlockProperties &a = setup.properties[piece.a], &b = setup.properties[piece.b];
    const double length = length_inside(piece.from, piece.to, part, tolerance);
    if (length <= 0.0 || a.fixed || b.fixed) continue;
    const contact::JointProperties& joint = joint_of(setup.joints, piece.label);
    const double normal =
        joint.normal_stiffness.value_or(setup.solver.penalty * std::min(a.material.young, b.material.young));
    add_joint((piece.to - piece.from) / norm(piece.to - piece.from), length, normal,
              joint.stiffness_ratio * normal);
  }
}

void RockSample::add_block(const block::Material& rock, double area) {
  const bool strain = rock.state == block::PlaneState::plane_strain;
  const double nu = rock.poisson, young = strain ? rock.young / (1.0 - nu * nu) : rock.young,
               in_section = strain ? nu / (1.0 - nu) : nu;
  ++blocks_;
  area_ += area;
  mass_ += rock.density * area;
  compliance_[0][0] += area / young;
  compliance_[1][1] += area / young;
  compliance_[0][1] -= area * in_section / young;
  compliance_[1][0] -= area * in_section / young;
  compliance_[2][2] += area * 2.0 * (1.0 + nu) / rock.young;
}

void RockSample::add_joint(Vec2 along, double length, double normal, double shear) {
  const Vec2 n{-along.y, along.x};
  const std::array<double, 3> closes{n.x * n.x, n.y * n.y, 2.0 * n.x * n.y},
      slips{-n.x * n.y, n.x * n.y, n.x * n.x - n.y * n.y};
  joint_length_ += length;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c)
      compliance_[r][c] += length * (closes[r] * closes[c] / normal + slips[r] * slips[c] / shear);
  }
}

RockSample& RockSample::operator+=(const RockSample& other) {
  whole_ += other.whole_;
  filled_ += other.filled_;
  area_ += other.area_;
  mass_ += other.mass_;
  joint_length_ += other.joint_length_;
  blocks_ += other.blocks_;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) compliance_[r][c] += other.compliance_[r][c];
  }
  return *this;
}

std::optional<dynamics::RockLayer> RockSample::layer(double top) const {
  if (!(area_ > 0.0)) return std::nullopt;
  Matrix s = compliance_;
  for (auto& row : s) {
    for (double& entry : row) entry /= area_;
  }
  const auto minor = [&](std::size_t r1, std::size_t r2, std::size_t c1, std::size_t c2) {
    return s[r1][c1] * s[r2][c2] - s[r1][c2] * s[r2][c1];
  };
  const double determinant =
      s[0][0] * minor(1, 2, 1, 2) - s[0][1] * minor(1, 2, 0, 2) + s[0][2] * minor(1, 2, 0, 1);
  return dynamics::RockLayer{.top = top,
                             .density = mass_ / area_,
                             .shear = minor(0, 1, 0, 1) / determinant,
                             .upright = minor(0, 2, 0, 2) / determinant,
                             .sideways = -minor(0, 2, 1, 2) / determinant};
}

}  // namespace keyblock::simulation
