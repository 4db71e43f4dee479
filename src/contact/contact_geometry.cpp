#include "contact/contact_geometry.h"

#include "contact/contact_lanes.h"
#include "contact/shared_length.h"
#include "core/index.h"

namespace keyblock::contact {

namespace {

/// Some vertices, as many as there are lanes, and what their edges have in common with a line each.
struct Vertices {
  Lanes corner[lane_count];                          ///< components of Corner
  Lanes length_before;                               ///< m, of the edge that ends there
  std::array<std::size_t, lane_count> next, before;  ///< the edges that begin and end there
  Lanes offset;                                      ///< m, Memory::offset of their contacts

  /// One of their edges, where it faces the line: they run against each other, both with their block on the left.
  struct Facing {
    LaneCondition faces;
    Lanes common;       ///< m of the line that the vertex has of what both share; 0 where it does not face
    Lanes long_beside;  ///< m
    Lanes length;       ///< m, of the edge of the vertex
    Beside<Lanes> edge, line;  ///< at the end that the vertex is nearer to
  };
};

/// What is measured of contacts reads this.
struct Outlines {
  const Surface& surface;
  const Tolerances& tolerances;
  std::span<const Corner> corners;
  std::span<const WholeEdge> wholes;
};

/// Calls of_edge(facing) for both edges of the vertices. line: components of Corner. Where no edge is divided, each vertex has the half of
/// what edges have in common.
template <bool divided, typename OfEdge>
void for_facing(const Outlines& outlines, const Vertices& vertices, const Lanes (&line)[lane_count],
                const std::array<std::size_t, lane_count>& lines, const OfEdge& of_edge) {
  const Lanes(&vertex)[lane_count] = vertices.corner;
  const Lanes tx = line[2], ty = line[3], along = tx * (vertex[0] - line[0]) + ty * (vertex[1] - line[1]);
  const Lanes depth = tx * (vertex[1] - line[1]) - ty * (vertex[0] - line[0]) - vertices.offset;
  const auto whole_edge = [&](const std::array<std::size_t, lane_count>& of) -> Beside<Lanes> {
    if constexpr (!divided) return {broadcast(0.5), Lanes{}, Lanes{}, broadcast(1.0)};
    Lanes w[lane_count];
    for (std::size_t i = 0; i < lane_count; ++i) w[i] = load(&outlines.wholes[of[i]].from.x);
    transpose(w);
    return {w[4], tx * (w[0] - line[0]) + ty * (w[1] - line[1]),
            tx * (w[2] - line[0]) + ty * (w[3] - line[1]), w[5]};
  };
  const SharedLength<Lanes> shared{along,
                                   line[6],
                                   outlines.tolerances.end_zone,
                                   outlines.tolerances.activation,
                                   outlines.tolerances.depth_limit,
                                   Tolerances::sine_facing};
  const auto measure_edge = [&](Lanes ux, Lanes uy, Lanes length, Lanes sign, const Beside<Lanes>& edge,
                                const Beside<Lanes>& of_line) {
    const Lanes across = ty * ux - tx * uy, forward = ux * tx + uy * ty, to = along + forward * sign * length,
                long_beside = shared.stretch(depth, sign * across, shared.opposite(to));
    const auto faces =
        ~((forward > 0.0) | (across * across > Tolerances::sine_facing * Tolerances::sine_facing));
    const Lanes of_vertex =
        divided ? shared(to, long_beside, edge, of_line) : 0.5 * shared.common(to, long_beside);
    of_edge(Vertices::Facing{faces, where(faces, of_vertex, Lanes{}), long_beside, length, edge, of_line});
  };
  const Beside<Lanes> here = whole_edge(lines);
  measure_edge(vertex[2], vertex[3], vertex[6], broadcast(1.0), whole_edge(vertices.next), at_end(here));
  measure_edge(vertex[4], vertex[5], vertices.length_before, broadcast(-1.0),
               at_end(whole_edge(vertices.before)), here);
}

/// m, what the contacts of two corners have of the edges on the other side of the corner, where one face continues the other. Edges of blocks
/// of order > 1 are divided at the same points on both sides of a joint, and one contact is left of the two vertices that meet there.
template <bool divided>
Lanes length_beyond(const Outlines& outlines, const Vertices& vertices, const Lanes (&edge)[lane_count],
                    const std::array<std::size_t, lane_count>& beyond) {
  Lanes line[lane_count], length{};
  for (std::size_t i = 0; i < lane_count; ++i) line[i] = load(&outlines.corners[beyond[i]].position.x);
  transpose(line);
  const Lanes forward = edge[2] * line[2] + edge[3] * line[3], across = edge[2] * line[3] - edge[3] * line[2];
  const auto continues =
      (forward >= 0.0) & (across * across <= Tolerances::sine_facing * Tolerances::sine_facing);
  if (!any(continues)) return length;
  for_facing<divided>(outlines, vertices, line, beyond,
                      [&](const Vertices::Facing& f) { length += f.common; });
  return where(continues, length, Lanes{});
}

/// Eight at once, or fewer at the end.
template <bool divided>
ContactGeometry measure(const Outlines& outlines, std::span<const Candidate> candidates,
                        std::span<const FoundContact> found, std::span<const Memory> memories) {
  const Surface& surface = outlines.surface;
  Vertices vertices;
  Lanes edge[lane_count];
  std::array<std::size_t, lane_count> edges;
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Candidate& c = candidates[at(found[i < found.size() ? i : 0].candidate)];
    edges[i] = at(c.edge);
    vertices.next[i] = at(c.vertex);
    vertices.before[i] = at(surface.previous[at(c.vertex)]);
    edge[i] = load(&outlines.corners[edges[i]].position.x);
    vertices.corner[i] = load(&outlines.corners[vertices.next[i]].position.x);
  }
  transpose(edge);
  transpose(vertices.corner);
  vertices.length_before =
      each_lane([&](std::size_t i) { return outlines.corners[vertices.before[i]].length; });
  vertices.offset = each_lane([&](std::size_t i) {
    const int k = i < found.size() ? found[i].memory : -1;
    return k >= 0 ? memories[at(k)].offset : 0.0;
  });
  const auto at_corner = lanes_where(found, [](const FoundContact& f) { return f.at_corner; });
  const Lanes dx = vertices.corner[0] - edge[0], dy = vertices.corner[1] - edge[1], length = edge[6],
              position = (edge[2] * dx + edge[3] * dy) / length,
              most = broadcast(outlines.tolerances.least_length);
  Lanes shared_length{}, whole_length{};
  auto shares_much = whole_length > 0.0, any_faces = shares_much;
  for_facing<divided>(outlines, vertices, edge, edges, [&](const Vertices::Facing& f) {
    shared_length += f.common;
    any_faces = any_faces | f.faces;
    whole_length =
        largest(whole_length, where((f.common > outlines.tolerances.rounding) | (f.faces & at_corner),
                                    least(f.edge.share * f.length, f.line.share * length), Lanes{}));
    if (!divided) return;  // edges that have that length in common give each vertex more than the least
    const Lanes overlap = least(largest(f.edge.from, f.edge.to), f.line.to) -
                          largest(least(f.edge.from, f.edge.to), f.line.from);
    shares_much = shares_much | (f.faces & (least(overlap, f.long_beside) >= 2.0 * most));
  });
  // A vertex that faces the edge and shares nothing of it, not even where two corners meet, is held by the edge beside.
  const auto is_one_of_many = shares_much | (any_faces & ~(whole_length > 0.0));
  const Lanes enough = where(is_one_of_many, Tolerances::least_of_many * most, most);
  ContactGeometry geometry{edge[3] * dx - edge[2] * dy,
                           position,
                           shared_length,
                           where(whole_length > 0.0, least(whole_length, enough), enough),
                           Lanes{},
                           edges};
  if (any(at_corner)) {
    for (std::size_t i = 0; i < lane_count; ++i)
      geometry.beyond[i] = at((position[i] < 0.5 ? surface.previous : surface.next)[edges[i]]);
    geometry.length_beyond =
        where(at_corner, length_beyond<divided>(outlines, vertices, edge, geometry.beyond), Lanes{});
  }
  return geometry;
}

}  // namespace

ContactGeometry measure_contacts(const Surface& surface, const Tolerances& tolerances, const Corners& corners,
                                 std::span<const Candidate> candidates, std::span<const FoundContact> found,
                                 std::span<const Memory> memories) {
  const Outlines outlines{surface, tolerances, corners.all(), corners.whole_edges()};
  return outlines.wholes.empty() ? measure<false>(outlines, candidates, found, memories)
                                 : measure<true>(outlines, candidates, found, memories);
}

}  // namespace keyblock::contact
