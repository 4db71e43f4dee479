#include "drawing/curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drawing/drawing.h"

namespace keyblock::drawing {
namespace {

constexpr double radians = std::numbers::pi / 180.0;

// Chords of an angle; one that is a whole number of them but for rounding gets no further one.
int chords_of(double angle) {
  constexpr double rounding = 1e-9;
  return std::max(1, static_cast<int>(std::ceil(std::abs(angle) / (chord_angle * radians) - rounding)));
}

// By de Boor's algorithm, on points (w x, w y, w).
Vec2 point_at(const Spline& spline, std::size_t span, double t) {
  struct Weighted {
    Vec2 p;
    double w = 1.0;
  };
  const auto degree = static_cast<std::size_t>(spline.degree);
  std::vector<Weighted> d(degree + 1);
  for (std::size_t j = 0; j <= degree; ++j) {
    const std::size_t i = span - degree + j;
    const double w = spline.weights.empty() ? 1.0 : spline.weights[i];
    d[j] = {w * spline.points[i], w};
  }
  for (std::size_t r = 1; r <= degree; ++r) {
    for (std::size_t j = degree; j >= r; --j) {
      const std::size_t i = span - degree + j;
      const double low = spline.knots[i], high = spline.knots[i + degree - r + 1];
      const double share = high > low ? (t - low) / (high - low) : 0.0;
      d[j] = {lerp(d[j - 1].p, d[j].p, share), (1.0 - share) * d[j - 1].w + share * d[j].w};
    }
  }
  return d[degree].p / d[degree].w;
}

class Halving {
 public:
  Halving(const Spline& spline, double sagitta, std::vector<Vec2>& vertices)
      : spline_(spline), sagitta_(sagitta), vertices_(vertices) {}

  // Adds the vertices after a, up to b.
  void span(std::size_t k, double from, Vec2 a, double to, Vec2 b, int depth) {
    constexpr int least = 2, most = 7;  // the middle of an S lies on its chord
    const double middle = 0.5 * (from + to);
    const Vec2 p = point_at(spline_, k, middle);
    const double length = norm(b - a);
    const double off = length > 0.0 ? std::abs(cross(b - a, p - a)) / length : norm(p - a);
    if (depth >= most || (depth >= least && off <= sagitta_)) {
      vertices_.push_back(b);
      return;
    }
    span(k, from, a, middle, p, depth + 1);
    span(k, middle, p, to, b, depth + 1);
  }

 private:
  const Spline& spline_;
  double sagitta_;
  std::vector<Vec2>& vertices_;
};

}  // namespace

std::vector<Vec2> ellipse_arc(Vec2 centre, Vec2 u, Vec2 v, double from, double to) {
  const int chords = chords_of(to - from);
  std::vector<Vec2> vertices;
  for (int k = 0; k <= chords; ++k) {
    const double t = from + (to - from) * k / chords;
    vertices.push_back(centre + std::cos(t) * u + std::sin(t) * v);
  }
  return vertices;
}

void append_bulge(Vec2 a, Vec2 b, double bulge, std::vector<Vec2>& vertices) {
  const double angle = 4.0 * std::atan(bulge);
  const int chords = chords_of(angle);
  // The chord a b is seen from the centre under the angle; its middle is r cos(angle/2) away.
  const Vec2 half = 0.5 * (b - a);
  if (chords == 1 || half == Vec2{}) return;
  const Vec2 centre = a + half + ((1.0 - bulge * bulge) / (2.0 * bulge)) * perpendicular(half);
  for (int k = 1; k < chords; ++k) {
    const double turn = angle * k / chords;
    vertices.push_back(centre + std::cos(turn) * (a - centre) + std::sin(turn) * perpendicular(a - centre));
  }
}

bool Spline::is_sound() const {
  constexpr int highest_degree = 25;
  if (degree < 1 || degree > highest_degree) return false;
  const auto order = static_cast<std::size_t>(degree) + 1;
  return points.size() >= order && knots.size() == points.size() + order && std::ranges::is_sorted(knots) &&
         (weights.empty() || weights.size() == points.size()) &&
         std::ranges::all_of(weights, [](double w) { return w > 0.0; });
}

std::vector<Vec2> spline_vertices(const Spline& spline) {
  Box box;
  for (const Vec2 p : spline.points) box.add(p);
  const double sagitta =
      0.5 * std::max(box.size().x, box.size().y) * (1.0 - std::cos(0.5 * chord_angle * radians));
  std::vector<Vec2> vertices;
  Halving halving(spline, sagitta, vertices);
  for (auto k = static_cast<std::size_t>(spline.degree); k < spline.points.size(); ++k) {
    const double from = spline.knots[k], to = spline.knots[k + 1];
    if (!(from < to)) continue;
    if (vertices.empty()) vertices.push_back(point_at(spline, k, from));
    halving.span(k, from, vertices.back(), to, point_at(spline, k, to), 0);
  }
  return vertices;
}

}  // namespace keyblock::drawing
