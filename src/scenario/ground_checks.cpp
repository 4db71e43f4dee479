#include "scenario/ground_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/magnitudes.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

/// Of the height of the domain: what ends so close below the top is meant to open the ground, and was drawn a little short of it.
constexpr double at_the_top = 0.01;

/// Whether the excavation comes up to the top of the domain, and leaves rock beside it there.
bool cuts_the_ground(const ExcavationSpec& spec, const Box& domain) {
  const double top = domain.max.y - at_the_top * domain.size().y;
  double left = HUGE_VAL, right = -HUGE_VAL;
  for (const Vec2 p : excavation_outline(spec)) {
    if (p.y < top) continue;
    left = std::min(left, p.x);
    right = std::max(right, p.x);
  }
  const bool is_all = left <= domain.min.x && right >= domain.max.x;
  return left < right && !is_all;
}

}  // namespace

void add_ground_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  // With in-situ stress of rock above, the top of the model is no ground.
  const bool is_buried = scenario.in_situ && scenario.in_situ->depth.value_or(HUGE_VAL) > 0.0;
  if (!scenario.domain || !scenario.domain->frame || scenario.boundary || is_buried ||
      scenario.accepted.closed_ground)
    return;
  for (const ExcavationSpec& spec : scenario.excavations) {
    if (!cuts_the_ground(spec, scenario.domain->box())) continue;
    warnings.push_back(fmt::format(
        "domain.boundary{} = \"frame\": closed ground: {} comes up to the top of the domain, and the frame "
        "lies on the ground beside it; nothing rises or topples there, and rock that would may seem "
        "to stand; [boundary] with base = \"rigid\", sides = \"roller\", top = \"free\" leaves the "
        "ground free",
        place_text(scenario, "domain.boundary"), spec.path));
    return;
  }
}

}  // namespace keyblock::scenario
