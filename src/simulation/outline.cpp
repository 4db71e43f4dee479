#include "simulation/outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "contact/candidates.h"
#include "contact/edge_curve.h"
#include "core/index.h"
#include "geometry/quadrature.h"

namespace keyblock::simulation {

namespace {

using contact::Surface;
using dynamics::Block;
using dynamics::Model;

/// Where an edge of so many pieces is divided, as a share of it: at the points of Gauss and Lobatto's rule, whose weights are what forces on
/// the vertices have to be for a traction along the edge to do the same work on a block of that order.
const contact::EdgeDivision& division(int pieces) {
  static std::map<int, contact::EdgeDivision> divisions;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  return divisions.try_emplace(pieces, gauss_lobatto(pieces + 1).points).first->second;
}

/// Surface::start_share of the pieces: such that each vertex comes to its weight.
std::vector<double> start_shares(int pieces) {
  const LineRule& rule = gauss_lobatto(pieces + 1);
  std::vector<double> shares;
  double of_piece_before = 0.0;
  for (std::size_t k = 0; k < at(pieces); ++k) {
    const double length = rule.points[k + 1] - rule.points[k], at_start = rule.weights[k] - of_piece_before;
    shares.push_back(at_start / length);
    of_piece_before = length - at_start;
  }
  return shares;
}

/// Part of an edge of a polygon.
struct Part {
  double from = 0.0, to = 1.0;  ///< as shares of the edge
  int pieces = 1;
};

/// Of a whole edge, where it is not told otherwise.
constexpr Part whole[] = {Part{}};

/// Adds edge k of a ring of a block, in its parts.
void add_edge(Surface& surface, int block, int joint, const Ring& ring, std::size_t k,
              std::span<const Part> parts) {
  const Vec2 before = ring[(k + ring.size() - 1) % ring.size()], here = ring[k],
             after = ring[(k + 1) % ring.size()];
  const contact::CornerKind kind = contact::corner_kind(here - before, after - here);
  const std::size_t corner = surface.block.size();
  for (const Part& part : parts) {
    const std::vector<double> shares = start_shares(part.pieces);
    surface.start_share.insert(surface.start_share.end(), shares.begin(), shares.end());
    surface.divided.insert(surface.divided.end(), at(part.pieces),
                           {surface.vertices(), part.pieces, &division(part.pieces)});
    for (int piece = 0; piece < part.pieces; ++piece) {
      const double share = std::lerp(part.from, part.to, division(part.pieces).points[at(piece)]);
      surface.kind.push_back(surface.block.size() == corner ? kind : contact::CornerKind::convex);
      surface.block.push_back(block);
      surface.joint.push_back(joint);
      surface.position.push_back(lerp(here, after, share));
    }
  }
}

/// The outlines of the blocks; parts: of each edge of the polygons, or none.
Surface outlines(const Model& model, std::span<const int> joint, std::span<const std::vector<Part>> parts,
                 std::vector<int>& outline_edge) {
  Surface surface;
  surface.block_begin.push_back(0);
  outline_edge.clear();
  std::size_t edge = 0;
  for (const Block& block : model.blocks) {
    const int number = surface.blocks();
    for (std::size_t r = 0; r < block.reference.ring_count(); ++r) {
      const Ring& ring = block.reference.ring(r);
      const int first = surface.vertices();
      for (std::size_t k = 0; k < ring.size(); ++k, ++edge) {
        add_edge(surface, number, joint[edge], ring, k,
                 parts.empty() ? std::span<const Part>(whole) : parts[edge]);
        outline_edge.resize(at(surface.vertices()), static_cast<int>(edge));
      }
      const int count = surface.vertices() - first;
      for (int k = 0; k < count; ++k) {
        surface.next.push_back(first + (k + 1) % count);
        surface.previous.push_back(first + (k + count - 1) % count);
      }
    }
    surface.block_begin.push_back(surface.vertices());
    surface.thickness.push_back(block.area / perimeter(block.reference));
    surface.present.push_back(1);
    surface.fixed.push_back(block.fixed);
  }
  if (std::ranges::all_of(surface.divided, [](const auto& of) { return of.pieces == 1; })) {
    surface.divided.clear();
    surface.start_share.clear();
  }
  return surface;
}

/// A block along some of an edge.
struct Neighbour {
  double from, to;  ///< m, along the edge
  int block;
};

/// Divides the edges of the polygons of a model: `corners` has one edge for each.
class Divider {
 public:
  Divider(const Model& model, const Surface& corners)
      : model_(model),
        corners_(corners),
        tolerances_(model.block_size),
        neighbours_(at(corners.vertices())) {}

  std::vector<std::vector<Part>> parts() {
    find_neighbours();
    std::vector<std::vector<Part>> parts(neighbours_.size());
    for (std::size_t e = 0; e < parts.size(); ++e) parts[e] = parts_of(e);
    return parts;
  }

 private:
  [[nodiscard]] const Block& block_of(std::size_t edge) const {
    return model_.blocks[at(corners_.block[edge])];
  }
  [[nodiscard]] Vec2 along(std::size_t edge) const {
    return corners_.position[at(corners_.next[edge])] - corners_.position[edge];
  }

  void find_neighbours() {
    ThreadTeam alone(1);
    contact::CandidateList near;
    contact::Candidates(tolerances_)
        .update(corners_, std::vector<double>(model_.blocks.size(), 0.0), near, alone);
    for (const contact::Candidate& c : near.pairs) {
      const std::size_t v = at(c.vertex), e = at(c.edge);
      if (contact::distance_to_segment(corners_.position[v], corners_.position[e],
                                       corners_.position[at(corners_.next[e])]) > tolerances_.in_place)
        continue;
      add_common(v, e);
      add_common(at(corners_.previous[v]), e);
    }
  }

  /// What edges of two blocks have in common, where they face each other and stay beside each other to its ends: those that part at a
  /// crossing do not.
  void add_common(std::size_t one, std::size_t other) {
    const Vec2 u = along(one), v = along(other);
    if (dot(u, v) > 0.0 || std::abs(cross(u, v)) > contact::Tolerances::sine_facing * norm(u) * norm(v))
      return;
    const auto add = [&](std::size_t edge, std::size_t beside) {
      const double length = norm(along(edge));
      const Vec2 tangent = (1.0 / length) * along(edge);
      const auto of_edge = [&](std::size_t vertex) {
        const Vec2 r = corners_.position[vertex] - corners_.position[edge];
        return Vec2{dot(tangent, r), cross(tangent, r)};  // along and across it
      };
      const Vec2 begin = of_edge(at(corners_.next[beside])), end = of_edge(beside);
      const double from = std::max(begin.x, 0.0), to = std::min(end.x, length);
      const auto is_beside = [&](double x) {
        return std::abs(std::lerp(begin.y, end.y, (x - begin.x) / (end.x - begin.x))) <=
               tolerances_.activation;
      };
      if (to - from > tolerances_.end_zone && is_beside(from) && is_beside(to))
        neighbours_[edge].push_back({from, to, corners_.block[beside]});
    };
    add(one, other);
    add(other, one);
  }

  [[nodiscard]] std::vector<Part> parts_of(std::size_t edge) const {
    const Block& block = block_of(edge);
    if (block.edge_order == 1) return {Part{}};
    const double length = norm(along(edge));
    std::vector<double> ends{0.0};
    for (const Neighbour& n : neighbours_[edge]) ends.insert(ends.end(), {n.from, n.to});
    std::ranges::sort(ends);
    std::vector<Part> parts;
    double from = 0.0;
    const auto end_part = [&](double to, double share) {
      parts.push_back({parts.empty() ? 0.0 : parts.back().to, share, pieces(edge, from, to)});
      from = to;
    };
    for (const double end : ends) {
      if (end - from > tolerances_.end_zone && length - end > tolerances_.end_zone)
        end_part(end, end / length);
    }
    end_part(length, 1.0);
    return parts;
  }

  /// Of a part of an edge, m: as many as the block needs, or one on its other side that is divided too.
  [[nodiscard]] int pieces(std::size_t edge, double from, double to) const {
    std::vector<const Block*> sides{&block_of(edge)};
    for (const Neighbour& n : neighbours_[edge]) {
      const Block& block = model_.blocks[at(n.block)];
      if (block.edge_order > 1 && std::min(to, n.to) - std::max(from, n.from) > tolerances_.end_zone)
        sides.push_back(&block);
    }
    int order = 1, most = 1;
    for (const Block* side : sides) order = std::max(order, side->edge_order);
    for (const Block* side : sides) most = std::max(most, edge_pieces(to - from, side->area, order));
    return most;
  }

  const Model& model_;
  const Surface& corners_;
  contact::Tolerances tolerances_;
  std::vector<std::vector<Neighbour>> neighbours_;  ///< of every edge
};

}  // namespace

int edge_pieces(double edge_length, double block_area, int order) {
  // Of the edge, the share of its first vertex is 1 / (n (n + 1)).
  constexpr double least = 0.01, rounding = 1e-6;
  const double most = (1.0 + rounding) * edge_length / (least * std::sqrt(block_area));
  int pieces = 1;
  while (pieces < order && (pieces + 1) * (pieces + 2) <= most) ++pieces;
  return pieces;
}

void build_surface(Model& model, std::span<const int> joint) {
  model.surface = outlines(model, joint, {}, model.outline_edge);
  if (std::ranges::any_of(model.blocks, [](const Block& b) { return b.edge_order > 1; })) {
    const std::vector<std::vector<Part>> parts = Divider(model, model.surface).parts();
    model.surface = outlines(model, joint, parts, model.outline_edge);
  }
  model.reference = model.surface.position;
  evaluate_basis(model);
}

void find_seams(Model& model) {
  constexpr double sine_of_straight = 1e-6;  // sine of the angle between the two edges
  contact::Surface& surface = model.surface;
  std::vector<std::uint8_t> seams(surface.block.size(), 0);
  for (std::size_t v = 0; v < seams.size(); ++v) {
    const std::size_t before = at(surface.previous[v]);
    const contact::JointLaw &one = model.laws[at(surface.joint[before])],
                            &other = model.laws[at(surface.joint[v])];
    if (one == other || one.fused || other.fused) continue;
    const Vec2 in = normalized(surface.position[v] - surface.position[before]),
               out = normalized(surface.position[at(surface.next[v])] - surface.position[v]);
    if (dot(in, out) > 0.0 && std::abs(cross(in, out)) <= sine_of_straight) seams[v] = 1;
  }
  if (std::ranges::find(seams, 1) != seams.end()) surface.is_seam = std::move(seams);
}

void evaluate_basis(Model& model) {
  contact::Surface& surface = model.surface;
  surface.phi.clear();
  surface.phi_begin.clear();
  for (std::size_t v = 0; v < model.reference.size(); ++v) {
    const Block& block = model.blocks[at(surface.block[v])];
    surface.phi_begin.push_back(surface.phi.size());
    surface.phi.resize(surface.phi.size() + at(block.size));
    block.basis.evaluate(model.reference[v], surface.phi.data() + surface.phi_begin[v]);
  }
}

}  // namespace keyblock::simulation
