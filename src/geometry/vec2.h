#pragma once
#include <cmath>

namespace keyblock {

/// A point or vector of the section plane; x to the right, y up.
struct Vec2 {
  double x = 0.0;
  double y = 0.0;

  constexpr Vec2& operator+=(Vec2 b) {
    x += b.x;
    y += b.y;
    return *this;
  }
  constexpr Vec2& operator-=(Vec2 b) {
    x -= b.x;
    y -= b.y;
    return *this;
  }
  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
  friend constexpr Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
  friend constexpr Vec2 operator*(Vec2 a, double s) { return s * a; }
  friend constexpr Vec2 operator/(Vec2 a, double s) { return {a.x / s, a.y / s}; }
  friend constexpr bool operator==(Vec2, Vec2) = default;
};

constexpr double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}
/// z component of a × b: positive when b lies counter-clockwise of a.
constexpr double cross(Vec2 a, Vec2 b) {
  return a.x * b.y - a.y * b.x;
}
/// a turned by +90°.
constexpr Vec2 perpendicular(Vec2 a) {
  return {-a.y, a.x};
}
constexpr double squared_norm(Vec2 a) {
  return dot(a, a);
}
inline double norm(Vec2 a) {
  return std::sqrt(dot(a, a));
}
inline Vec2 normalized(Vec2 a) {
  return a / norm(a);
}
constexpr Vec2 lerp(Vec2 a, Vec2 b, double s) {
  return (1.0 - s) * a + s * b;
}

/// Axis-aligned box; empty until something is added.
struct Box {
  Vec2 min{HUGE_VAL, HUGE_VAL};
  Vec2 max{-HUGE_VAL, -HUGE_VAL};

  void add(Vec2 p) {
    min = {std::fmin(min.x, p.x), std::fmin(min.y, p.y)};
    max = {std::fmax(max.x, p.x), std::fmax(max.y, p.y)};
  }
  void add(const Box& b) {
    add(b.min);
    add(b.max);
  }
  [[nodiscard]] Box grown(double margin) const {
    return {{min.x - margin, min.y - margin}, {max.x + margin, max.y + margin}};
  }
  [[nodiscard]] bool overlaps(const Box& b) const {
    return min.x <= b.max.x && b.min.x <= max.x && min.y <= b.max.y && b.min.y <= max.y;
  }
  [[nodiscard]] bool contains(Vec2 p) const {
    return min.x <= p.x && p.x <= max.x && min.y <= p.y && p.y <= max.y;
  }
  [[nodiscard]] Vec2 size() const { return max - min; }
};

}  // namespace keyblock
