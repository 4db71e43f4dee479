#pragma once
#include <vector>

#include "geometry/vec2.h"

/// Curves of drawings as chords of at most chord_angle (drawing.h). All vertices lie on the curve.
namespace keyblock::drawing {

/// c + cos(t) u + sin(t) v for t from `from` to `to` (radians, to > from), both ends included.
std::vector<Vec2> ellipse_arc(Vec2 centre, Vec2 u, Vec2 v, double from, double to);

/// Vertices between a and b, both left out, of the arc of the bulge tan(θ/4): θ is the angle of the arc, positive when it runs counter-clockwise.
void append_bulge(Vec2 a, Vec2 b, double bulge, std::vector<Vec2>& vertices);

/// A rational B-spline,
///
///     C(t) = Σ N_i(t) w_i P_i / Σ N_i(t) w_i,   t from knots[degree] to knots[n].
struct Spline {
  int degree = 3;
  std::vector<double> knots;    ///< ascending, as many as there are points, + degree + 1
  std::vector<Vec2> points;     ///< P_i, n of them
  std::vector<double> weights;  ///< w_i; empty: all are 1

  /// Whether the numbers of knots, points and weights go together.
  [[nodiscard]] bool is_sound() const;
};

/// Precondition: is_sound(). Spans are halved until a chord is as near to the curve as those of a circle of its size.
std::vector<Vec2> spline_vertices(const Spline& spline);

}  // namespace keyblock::drawing
