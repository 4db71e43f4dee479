#include "cutting/linework.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/error.h"
#include "cutting/segment_index.h"

namespace keyblock::cutting {

namespace {

constexpr int grid_bits = 44;  ///< steps of the grid across the domain, as a power of two
/// Steps by which rounding moves an end off a line it was on.
constexpr double rounding_reach = 2.0;

Ring checked_ring(const Ring& ring, const std::string& key, std::vector<Diagnostic>& mistakes) {
  Polygon polygon{ring, {}};
  if (polygon.outer.size() > 1 && polygon.outer.front() == polygon.outer.back()) polygon.outer.pop_back();
  const auto finite = [](Vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  Diagnostic mistake;
  mistake.key = key;
  if (polygon.outer.size() < 3 || polygon.outer.size() > std::numeric_limits<std::int16_t>::max()) {
    mistake.found = fmt::format("a ring of {} vertices", polygon.outer.size());
    mistake.expected = "3 to 32767 vertices";
  } else if (!std::all_of(polygon.outer.begin(), polygon.outer.end(), finite)) {
    mistake.found = "a coordinate that is not finite";
    mistake.expected = "finite coordinates";
  } else if (self_intersects(polygon) || signed_area(polygon.outer) == 0.0) {
    mistake.found = "a ring that crosses or touches itself";
    mistake.expected = "a simple polygon";
  } else {
    orient(polygon);
    return polygon.outer;
  }
  mistakes.push_back(std::move(mistake));
  return {};
}

void add_ring(std::vector<SourceLine>& lines, const Ring& ring, EdgeKind kind, int index) {
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto number = static_cast<std::int16_t>(kind == EdgeKind::domain ? static_cast<int>(k) : index);
    const GridPoint a = nearest_grid_point(ring[k]);
    const GridPoint b = nearest_grid_point(ring[(k + 1) % ring.size()]);
    if (!(a == b)) lines.push_back({a, b, {kind, number}});
  }
}

/// Clips segment ab to the box; false when nothing is left (Liang & Barsky 1984).
bool clip(const Box& box, Vec2& a, Vec2& b) {
  const Vec2 d = b - a;
  double from = 0.0, to = 1.0;
  const std::array<std::array<double, 2>, 4> sides{
      {{-d.x, a.x - box.min.x}, {d.x, box.max.x - a.x}, {-d.y, a.y - box.min.y}, {d.y, box.max.y - a.y}}};
  for (const auto& [p, q] : sides) {
    if (p == 0.0 && q < 0.0) return false;
    if (p < 0.0) from = std::max(from, q / p);
    if (p > 0.0) to = std::min(to, q / p);
  }
  if (from > to) return false;
  const Vec2 start = a;
  if (to < 1.0) b = start + to * d;
  if (from > 0.0) a = start + from * d;
  return true;
}

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b, Vec2& foot) {
  const Vec2 d = b - a;
  const double s = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
  foot = a + s * d;
  return norm(p - foot);
}

struct GridPointHash {
  std::size_t operator()(GridPoint p) const {
    const auto mixed =
        static_cast<std::uint64_t>(p.x) * 0x9E3779B97F4A7C15u ^ static_cast<std::uint64_t>(p.y);
    return static_cast<std::size_t>((mixed ^ mixed >> 29) * 0xBF58476D1CE4E5B9u);
  }
};

/// Puts ends of traces on the lines they nearly reach, one place after the other in the order of the input.
class EndSnapper {
 public:
  EndSnapper(std::vector<SourceLine>& lines, const Box& domain, double reach)
      : lines_(lines), near_domain_(domain.grown(reach)), reach_(reach), index_(domain, columns(lines)) {
    for (std::size_t k = 0; k < lines.size(); ++k) {
      index_.add(static_cast<int>(k), to_vec2(lines[k].a), to_vec2(lines[k].b));
      lines_at_[lines[k].a].push_back(k);
      lines_at_[lines[k].b].push_back(k);
    }
  }

  void run() {
    for (const SourceLine& line : lines_) {
      if (line.trace < 0) continue;
      snap(line, line.a);
      snap(line, line.b);
    }
  }

 private:
  static int columns(const std::vector<SourceLine>& lines) {
    return std::clamp(static_cast<int>(2.0 * std::sqrt(static_cast<double>(lines.size()))), 8, 1024);
  }

  [[nodiscard]] GridPoint far_end(std::size_t line, GridPoint end) const {
    return lines_[line].a == end ? lines_[line].b : lines_[line].a;
  }

  /// A corner of the domain or of an outline.
  [[nodiscard]] bool is_fixed(GridPoint end) const {
    const std::vector<std::size_t>& here = lines_at_.at(end);
    return std::any_of(here.begin(), here.end(), [&](std::size_t k) { return lines_[k].trace < 0; });
  }

  /// How far the lines that end in a place may be moved: where a trace passes through (a vertex of a polyline), only
  /// by what rounding does.
  [[nodiscard]] double reach_at(GridPoint end) const {
    const std::vector<std::size_t>& here = lines_at_.at(end);
    const Vec2 p = to_vec2(end);
    for (const std::size_t i : here) {
      for (const std::size_t j : here) {
        if (dot(to_vec2(far_end(i, end)) - p, to_vec2(far_end(j, end)) - p) < 0.0) return rounding_reach;
      }
    }
    return reach_;
  }

  /// A line that ends here, or that continues a short one from here: no target.
  [[nodiscard]] bool is_joined(const SourceLine& other, GridPoint end) const {
    if (other.a == end || other.b == end) return true;
    const std::vector<std::size_t>& here = lines_at_.at(end);
    return std::any_of(here.begin(), here.end(), [&](std::size_t k) {
      const GridPoint far = far_end(k, end);
      return (other.a == far || other.b == far) && norm(to_vec2(far) - to_vec2(end)) <= 2.0 * reach_;
    });
  }

  /// The line nearest to an end within reach, the lower one of equals; null if there is none.
  [[nodiscard]] SourceLine* nearest_line(GridPoint end, double reach) const {
    const Vec2 p = to_vec2(end);
    int best = -1;
    double best_distance = reach;
    const double margin = reach + reach_;  // lines may have been moved by reach_ since they were indexed
    index_.near({{p.x - margin, p.y - margin}, {p.x + margin, p.y + margin}}, [&](int id) {
      const SourceLine& other = lines_[static_cast<std::size_t>(id)];
      if (other.a == other.b || is_joined(other, end)) return;
      Vec2 foot;
      const double distance = distance_to_segment(p, to_vec2(other.a), to_vec2(other.b), foot);
      if (distance < best_distance || (distance == best_distance && (best < 0 || id < best))) {
        best = id;
        best_distance = distance;
      }
    });
    return best < 0 ? nullptr : &lines_[static_cast<std::size_t>(best)];
  }

  void snap(const SourceLine& line, GridPoint end) {
    const Vec2 p = to_vec2(end);
    if (line.a == line.b || !near_domain_.contains(p) || is_fixed(end)) return;
    const double reach = reach_at(end);
    SourceLine* target = nearest_line(end, reach);
    if (target == nullptr) return;
    const Vec2 a = to_vec2(target->a), b = to_vec2(target->b);
    Vec2 place;
    distance_to_segment(p, a, b, place);
    // Along the trace itself where that is not much farther, so that it is not turned.
    const Vec2 start = to_vec2(line.a == end ? line.b : line.a);
    if (const double sine = cross(b - a, p - start); sine != 0.0) {
      const double s = cross(start - a, p - start) / sine;
      const Vec2 meeting = lerp(a, b, s);
      if (s >= 0.0 && s <= 1.0 && norm(meeting - p) <= 2.0 * reach) place = meeting;
    }
    const GridPoint node = nearest_grid_point(place);
    if (!(node == target->a) && !(node == target->b)) target->nodes.push_back(node);
    move(end, node);
  }

  void move(GridPoint end, GridPoint node) {
    if (end == node) return;
    const std::vector<std::size_t> moved = std::move(lines_at_[end]);
    lines_at_.erase(end);
    for (const std::size_t k : moved) {
      SourceLine& line = lines_[k];
      if (line.a == end) line.a = node;
      if (line.b == end) line.b = node;
    }
    std::vector<std::size_t>& there = lines_at_[node];
    there.insert(there.end(), moved.begin(), moved.end());
  }

  std::vector<SourceLine>& lines_;
  Box near_domain_;
  double reach_;  ///< steps
  SegmentIndex index_;
  std::unordered_map<GridPoint, std::vector<std::size_t>, GridPointHash>
      lines_at_;  ///< looked up, never walked
};

/// Puts vertices of an outline that lie within reach of the domain's edge on it.
void snap_outline(Ring& outline, const Ring& domain, double reach) {
  for (Vec2& p : outline) {
    double best = reach;
    Vec2 place = p, foot;
    for (std::size_t k = 0; k < domain.size(); ++k) {
      const double distance = distance_to_segment(p, domain[k], domain[(k + 1) % domain.size()], foot);
      if (distance <= best) {
        best = distance;
        place = foot;
      }
    }
    p = place;
  }
}

// Real coordinates have steps of their own, the larger the farther they are from 0. Where vertices may stay within such steps of each
// other the grid is no finer, so that blocks keep their shape when the shift is added.
double grid_of(const Box& box, int exponent, double cluster) {
  constexpr double many_steps = 1024.0;
  constexpr int digits = 52;  // of a double after the first, binary
  const double far =
      std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x), std::abs(box.max.y)});
  const double grid = std::ldexp(1.0, exponent - grid_bits), step = std::ldexp(1.0, std::ilogb(far) - digits);
  return cluster < many_steps * step ? std::max(grid, step) : grid;
}

/// They are traces after those of the joints.
void add_bridges_in_gaps(const CutInput& input, const Box& window, Linework& work) {
  if (!input.bridges) return;
  int number = static_cast<int>(input.traces.size());
  for (const rockmass::Trace& gap : input.bridges->in_gaps) {
    const int trace = number++;
    Vec2 a = gap.a, b = gap.b;
    if (!clip(window, a, b)) continue;
    const GridPoint from = work.to_grid(a), to = work.to_grid(b);
    if (!(from == to)) work.lines.push_back({from, to, input.bridges->label, trace});
  }
}

}  // namespace

EdgeLabel label_of(const rockmass::Trace& trace) {
  const bool statistical = trace.source.kind == rockmass::TraceSource::Kind::joint_set;
  return {statistical ? EdgeKind::joint_set : EdgeKind::trace_map,
          static_cast<std::int16_t>(trace.source.index), trace.number};
}

Linework make_linework(const CutInput& input, const CutTolerances& tolerances) {
  const double snapping = tolerances.snapping;
  Linework work;
  std::vector<Diagnostic> mistakes;
  const Ring domain = checked_ring(input.domain, "domain", mistakes);
  std::vector<Ring> outlines;
  for (std::size_t k = 0; k < input.excavations.size(); ++k) {
    outlines.push_back(checked_ring(input.excavations[k], fmt::format("excavation[{}]", k), mistakes));
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));

  const Box box = bounds({domain, {}});
  const int exponent = std::ilogb(std::max(box.size().x, box.size().y)) + 1;
  const double unit = std::ldexp(1.0, exponent - 8);
  const Vec2 centre = 0.5 * (box.min + box.max);
  work.grid = grid_of(box, exponent, tolerances.cluster);
  work.shift = {std::nearbyint(centre.x / unit) * unit, std::nearbyint(centre.y / unit) * unit};
  work.domain_area = signed_area(domain);
  const auto on_grid = [&](const Ring& ring) {
    Ring rounded;
    for (const Vec2 p : ring) rounded.push_back(to_vec2(work.to_grid(p)));
    return rounded;
  };
  work.domain = on_grid(domain);
  add_ring(work.lines, work.domain, EdgeKind::domain, 0);
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    Ring outline = on_grid(outlines[k]);
    snap_outline(outline, work.domain, snapping / work.grid);
    add_ring(work.lines, outline, EdgeKind::excavation, static_cast<int>(k));
    work.excavations.push_back(std::move(outline));
  }
  const Box window = box.grown(1e-2 * std::max(box.size().x, box.size().y) + 4.0 * snapping);
  for (std::size_t k = 0; k < input.traces.size(); ++k) {
    Vec2 a = input.traces[k].a, b = input.traces[k].b;
    if (!clip(window, a, b)) continue;
    const GridPoint from = work.to_grid(a), to = work.to_grid(b);
    if (!(from == to)) work.lines.push_back({from, to, label_of(input.traces[k]), static_cast<int>(k)});
  }
  add_bridges_in_gaps(input, window, work);
  EndSnapper(work.lines, bounds({work.domain, {}}), std::max(snapping / work.grid, rounding_reach)).run();
  std::erase_if(work.lines, [](const SourceLine& line) { return line.a == line.b && line.nodes.empty(); });
  return work;
}

std::vector<SourceLine> split_at_nodes(const std::vector<SourceLine>& lines) {
  std::vector<SourceLine> pieces;
  for (const SourceLine& line : lines) {
    std::vector<GridPoint> points = line.nodes;
    const Vec2 a = to_vec2(line.a), d = to_vec2(line.b) - a;
    std::sort(points.begin(), points.end(), [&](GridPoint p, GridPoint q) {
      const double s = dot(to_vec2(p) - a, d), t = dot(to_vec2(q) - a, d);
      return s != t ? s < t : p < q;
    });
    points.push_back(line.b);
    GridPoint from = line.a;
    for (const GridPoint to : points) {
      if (!(from == to)) pieces.push_back({from, to, line.label, line.trace});
      from = to;
    }
  }
  return pieces;
}

}  // namespace keyblock::cutting
