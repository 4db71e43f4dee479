#include "census/removal.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace keyblock::census {
namespace {

/// Sine of the angle between directions that are the same but for rounding.
constexpr double rounding = 1e-9;
/// Edges of which the direction is known less well have none.
constexpr double worst_direction = 0.2;

/// Sine of the angle to which the direction of a face is known.
double uncertainty(const HoldingFace& face, double accuracy) {
  return std::max(rounding, accuracy / face.edge_length);
}

bool leads_out(Vec2 u, std::span<const HoldingFace> faces, double accuracy) {
  return std::all_of(faces.begin(), faces.end(), [&](const HoldingFace& face) {
    return dot(u, face.out) <= uncertainty(face, accuracy);
  });
}

bool lies_along(Vec2 u, const HoldingFace& face, double accuracy) {
  const double sine = uncertainty(face, accuracy);
  return sine <= worst_direction && std::abs(dot(u, face.out)) <= sine;
}

/// Directions along faces that lead out, and that of the resultant.
struct WaysOut {
  bool any = false;
  std::optional<Vec2> best;  ///< nearest to the resultant, at less than 90° to it
};

WaysOut ways_out(std::span<const HoldingFace> faces, Vec2 resultant, double accuracy) {
  WaysOut ways;
  const Vec2 towards = normalized(resultant);
  if (leads_out(towards, faces, accuracy)) return {true, towards};
  double nearest = rounding;
  for (const HoldingFace& face : faces) {
    for (const Vec2 along : {perpendicular(face.out), -perpendicular(face.out)}) {
      const double cosine = dot(along, towards);
      if (ways.any && cosine <= nearest) continue;
      if (!leads_out(along, faces, accuracy)) continue;
      ways.any = true;
      if (cosine <= nearest) continue;
      nearest = cosine;
      ways.best = along;
    }
  }
  return ways;
}

/// Fills in what resists along the direction of a removal.
void resist(Removal& removal, std::span<const HoldingFace> faces, Vec2 resultant, double accuracy) {
  const Vec2 across = resultant - removal.driving * removal.direction;
  const double normal = norm(across);
  const bool is_pressed = normal > rounding * norm(resultant);
  double pressed_length = 0.0, friction = 0.0;
  bool is_on_one_side = false, is_on_the_other = false;
  const Vec2 left = perpendicular(removal.direction);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const HoldingFace& face = faces[f];
    if (!lies_along(removal.direction, face, accuracy)) continue;
    removal.sliding.push_back(f);
    (dot(face.out, left) > 0.0 ? is_on_one_side : is_on_the_other) = true;
    removal.resisting += face.cohesion * face.length;
    if (!is_pressed || dot(face.out, across) <= 0.0) continue;
    pressed_length += face.length;
    friction += face.friction_coefficient * face.length;
  }
  if (pressed_length > 0.0) removal.resisting += normal * friction / pressed_length;
  if (!is_pressed && removal.resisting == 0.0) {
    removal.mode = Mode::falls;
    removal.sliding.clear();
  } else {
    removal.mode = is_on_one_side && is_on_the_other ? Mode::slides_between : Mode::slides;
  }
}

}  // namespace

const char* mode_name(Mode mode) {
  switch (mode) {
    case Mode::falls:
      return "falls";
    case Mode::slides:
      return "slides";
    case Mode::slides_between:
      return "slides between faces";
    case Mode::stable:
      return "stable";
    case Mode::not_removable:
      break;
  }
  return "not removable";
}

double Removal::force_for(double wanted_factor) const {
  return std::max(0.0, driving - resisting / wanted_factor);
}

Removal find_removal(std::span<const HoldingFace> faces, Vec2 resultant, double accuracy) {
  Removal removal;
  if (norm(resultant) == 0.0) {
    removal.mode = Mode::stable;
    return removal;
  }
  const WaysOut ways = ways_out(faces, resultant, accuracy);
  if (!ways.best) {
    removal.mode = ways.any ? Mode::stable : Mode::not_removable;
    return removal;
  }
  removal.direction = *ways.best;
  removal.driving = dot(resultant, removal.direction);
  resist(removal, faces, resultant, accuracy);
  return removal;
}

}  // namespace keyblock::census
