#include "cutting/joint_course.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/index.h"

namespace keyblock::cutting {

namespace {

const double least_cosine_of_own = std::cos(std::numbers::pi / 6.0);
const double least_cosine_of_others = std::cos(std::numbers::pi / 180.0);

}  // namespace

JointCourse::JointCourse(const PlanarGraph& graph, std::function<bool(const GraphEdge&)> is_there)
    : graph_(graph),
      is_there_(std::move(is_there)),
      incident_(graph.edges_of_vertices()),
      marks_(graph.edges.size(), Mark::none) {}

HalfEdge JointCourse::next(HalfEdge h) const {
  const int v = graph_.target(h);
  const auto direction = [&](HalfEdge g) {
    const Vec2 d = to_vec2(graph_.point(graph_.target(g))) - to_vec2(graph_.point(graph_.origin(g)));
    return d / norm(d);
  };
  const Vec2 ahead = direction(h);
  HalfEdge best = -1;
  double best_cosine = -1.0;
  for (const int e : incident_[at(v)]) {
    const GraphEdge& edge = graph_.edges[at(e)];
    if (e == h / 2 || !is_there_(edge)) continue;
    const HalfEdge g = edge.from == v ? 2 * e : 2 * e + 1;
    const double cosine = dot(ahead, direction(g));
    const bool own = edge.label == graph_.edge(h).label;
    if (cosine <= best_cosine || cosine < (own ? least_cosine_of_own : least_cosine_of_others)) continue;
    best = g;
    best_cosine = cosine;
  }
  return best;
}

bool JointCourse::is_at_edge_of_rock(int vertex) const {
  return std::any_of(incident_[at(vertex)].begin(), incident_[at(vertex)].end(), [&](int e) {
    const EdgeKind kind = graph_.edges[at(e)].label.kind;
    return kind == EdgeKind::domain || kind == EdgeKind::excavation;
  });
}

JointCourse::End JointCourse::follow(HalfEdge h) {
  for (;;) {
    marks_[at(h / 2)] = Mark::seen;
    const HalfEdge beyond = next(h);
    if (beyond < 0 || marks_[at(beyond / 2)] != Mark::given)
      return {graph_.target(h), beyond >= 0, is_at_edge_of_rock(graph_.target(h))};
    h = beyond;
  }
}

std::vector<JointCourse::Stretch> JointCourse::stretches(const std::vector<std::size_t>& edges) {
  for (const std::size_t e : edges) marks_[e] = Mark::given;
  std::vector<Stretch> found;
  for (const std::size_t e : edges) {
    if (marks_[e] == Mark::seen) continue;
    const auto forward = static_cast<HalfEdge>(2 * e);
    const End to = follow(forward), from = follow(forward ^ 1);
    const bool runs_through = (to.goes_on || from.goes_on) && (to.goes_on || to.at_edge_of_rock) &&
                              (from.goes_on || from.at_edge_of_rock);
    found.push_back({graph_.edges[e].label, from.vertex, to.vertex, runs_through});
  }
  for (const std::size_t e : edges) marks_[e] = Mark::none;
  return found;
}

}  // namespace keyblock::cutting
