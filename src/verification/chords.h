#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "core/random.h"
#include "cutting/cut.h"
#include "geometry/vec2.h"
#include "rockmass/trace.h"

namespace keyblock::verification {

/// Cutting problem with a known answer: a convex window and chords of it. Chord ends keep away from one another and from the corners, so that moving them by a hair
/// changes no crossing.
struct Chords {
  Ring window;
  std::vector<rockmass::Trace> chords;
  int crossings = 0;

  Chords(std::uint64_t seed, std::uint32_t number) : random_(seed, number, 0, 0) {
    const int corners = 3 + static_cast<int>(8.0 * next());
    for (int k = 0; k < corners; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.6 * next()) / corners;
      window.push_back({3.0 + 7.0 * std::cos(angle), 4.0 * std::sin(angle) - 1.0});
    }
    draw_chords(1 + static_cast<int>(24.0 * next()));
    for (std::size_t m = 0; m < chords.size(); ++m) {
      for (std::size_t n = 0; n < m; ++n) crossings += cross_inside(chords[m], chords[n]);
    }
  }

  /// Euler's formula.
  [[nodiscard]] std::size_t faces() const { return 1 + chords.size() + static_cast<std::size_t>(crossings); }

  [[nodiscard]] cutting::CutInput input() const {
    cutting::CutInput input;
    input.domain = window;
    input.traces = chords;
    input.tolerances = cutting::CutTolerances{};
    return input;
  }

 private:
  double next() { return random_.uniform(draw_++); }

  void draw_chords(int wanted) {
    constexpr double apart = 0.02;
    constexpr std::uint32_t most_draws = 4000;
    std::vector<Vec2> ends;
    while (static_cast<int>(chords.size()) < wanted && draw_ < most_draws) {
      const auto [i, a] = point_on_edge();
      const auto [j, b] = point_on_edge();
      const auto taken = [&](Vec2 p) {
        return std::any_of(ends.begin(), ends.end(), [p](Vec2 q) { return norm(p - q) < apart; });
      };
      if (i == j || taken(a) || taken(b)) continue;
      ends.push_back(a);
      ends.push_back(b);
      chords.push_back({a, b, {rockmass::TraceSource::Kind::joint_set, 0}});
    }
  }
  std::pair<std::size_t, Vec2> point_on_edge() {
    const auto edge = static_cast<std::size_t>(next() * static_cast<double>(window.size()));
    return {edge, lerp(window[edge], window[(edge + 1) % window.size()], 0.02 + 0.96 * next())};
  }
  static bool cross_inside(const rockmass::Trace& s, const rockmass::Trace& t) {
    const auto side = [](const rockmass::Trace& line, Vec2 p) {
      return cross(line.b - line.a, p - line.a) > 0.0;
    };
    return side(s, t.a) != side(s, t.b) && side(t, s.a) != side(t, s.b);
  }

  RandomStream random_;
  std::uint32_t draw_ = 0;
};

}  // namespace keyblock::verification
