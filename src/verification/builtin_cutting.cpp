#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "core/random.h"
#include "cutting/cut.h"
#include "verification/builtin.h"
#include "verification/chords.h"

namespace keyblock::verification {
namespace {

using cutting::BlockSystem;
using cutting::CutBlock;
using cutting::CutInput;
using cutting::CutTolerances;
using cutting::EdgeKind;
using rockmass::Trace;

constexpr std::uint64_t seed = 2727;
constexpr std::uint32_t windows = 200;
constexpr std::uint32_t cluttered_windows = 50;
constexpr double off_frame_snapping = 1e-3;

// Whether every edge inside the domain belongs to exactly two different blocks, once in each sense, and every edge of the
// domain to one.
bool edges_are_shared(const BlockSystem& system) {
  using Key = std::tuple<double, double, double, double>;
  std::map<Key, std::pair<std::size_t, EdgeKind>> edges;
  for (std::size_t b = 0; b < system.blocks.size(); ++b) {
    const CutBlock& block = system.blocks[b];
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2 p = ring[k], q = ring[(k + 1) % ring.size()];
        if (!edges.try_emplace({p.x, p.y, q.x, q.y}, b, block.labels[r][k].kind).second) return false;
      }
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto [px, py, qx, qy] = edge.first;
    const auto other = edges.find({qx, qy, px, py});
    if (edge.second.second == EdgeKind::domain) return other == edges.end();
    return other != edges.end() && other->second.first != edge.second.first;
  });
}

/// Counts what is wrong.
struct Tally {
  int cases = 0, wrong_counts = 0, wrong_edges = 0;
  double area_error = 0.0;

  void add(const CutInput& input, std::size_t expected) {
    const BlockSystem system = cut(input);
    const double whole = std::abs(signed_area(input.domain));
    double sum = 0.0;
    for (const CutBlock& block : system.blocks) sum += area(block.polygon);
    ++cases;
    wrong_counts += system.blocks.size() != expected;
    wrong_edges += !edges_are_shared(system);
    area_error = std::max(area_error, std::abs(sum / whole - 1.0));
  }
  void report(const std::string& prefix, BuiltinResults& results) const {
    results[prefix + "cases"] = cases;
    results[prefix + "wrong_counts"] = wrong_counts;
    results[prefix + "wrong_edges"] = wrong_edges;
    results[prefix + "largest_area_error"] = area_error;
  }
};

void add_off_frame(const Chords& c, Tally& tally) {
  for (const double off : {-1e-4, -1e-7, -1e-12, -1e-17, 1e-17, 1e-12, 1e-7, 1e-4}) {
    CutInput input = c.input();
    input.tolerances->snapping = off_frame_snapping;
    for (Trace& t : input.traces) {
      const Vec2 d = off * normalized(t.b - t.a);
      t.a -= d;
      t.b += d;
    }
    tally.add(input, c.faces());
  }
}

// A point of the chord where no other chord is so near that what is put there could reach it.
Vec2 lonely_point(const Chords& c, const Trace& chord) {
  constexpr double reach = 1e-3;
  for (double share = 0.5;; share *= 0.97) {
    const Vec2 p = lerp(chord.a, chord.b, share);
    const bool alone = std::all_of(c.chords.begin(), c.chords.end(), [&](const Trace& t) {
      return t.a == chord.a || std::abs(cross(normalized(t.b - t.a), p - t.a)) > reach;
    });
    if (alone) return p;
  }
}

void add_cluttered(const Chords& c, Tally& tally) {
  CutInput input = c.input();
  for (const Trace& t : c.chords) {
    input.traces.push_back({t.b, t.a, t.source});
    input.traces.push_back({lerp(t.a, t.b, 0.25), lerp(t.a, t.b, 0.75), t.source});
    // A dead end that begins on the chord, and a joint alone in the rock.
    const Vec2 m = lonely_point(c, t), n = 1e-4 * normalized(perpendicular(t.b - t.a));
    input.traces.push_back({m, m + n, t.source});
    input.traces.push_back({m + 2.0 * n, m + 3.0 * n, t.source});
  }
  tally.add(input, c.faces());
}

void add_star(int lines, Tally& tally) {
  CutInput input;
  input.domain = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const Vec2 node{0.1, 0.07};
  for (int k = 0; k < lines; ++k) {
    const double angle = std::numbers::pi * (k + 0.31) / lines;
    const Vec2 d{4.0 * std::cos(angle), 4.0 * std::sin(angle)};
    input.traces.push_back({node - d, node + d, {}});
  }
  // In exact arithmetic the lines meet in one point, in rounded coordinates near it; clustering makes them meet.
  input.tolerances = CutTolerances{};
  input.tolerances->cluster = 1e-9;
  tally.add(input, static_cast<std::size_t>(2 * lines));
}

void add_island(BuiltinResults& results) {
  CutInput input;
  input.domain = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  for (const Ring& ring : {Ring{{2, 2}, {8, 2}, {8, 8}, {2, 8}}, Ring{{4, 4}, {6, 4}, {5, 6}}}) {
    for (std::size_t k = 0; k < ring.size(); ++k)
      input.traces.push_back({ring[k], ring[(k + 1) % ring.size()], {}});
  }
  const BlockSystem system = cut(input);
  std::size_t holes = 0;
  for (const CutBlock& block : system.blocks) holes += block.polygon.holes.size();
  results["island_blocks"] = static_cast<double>(system.blocks.size());
  results["island_holes"] = static_cast<double>(holes);
}

}  // namespace

BuiltinResults cutting_of_chords(const std::vector<std::filesystem::path>&) {
  Tally plain, off_frame, cluttered, star;
  for (std::uint32_t k = 0; k < windows; ++k) {
    const Chords chords(seed, k);
    plain.add(chords.input(), chords.faces());
    if (k >= cluttered_windows) continue;
    add_off_frame(chords, off_frame);
    add_cluttered(chords, cluttered);
  }
  for (const int lines : {3, 7, 40, 200}) add_star(lines, star);
  BuiltinResults results;
  plain.report("", results);
  off_frame.report("off_frame_", results);
  cluttered.report("cluttered_", results);
  star.report("star_", results);
  add_island(results);
  return results;
}

}  // namespace keyblock::verification
