#include "study/variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace keyblock::study {
namespace {

using record::Stage;
using record::StageKind;

constexpr double steepest_friction = 89.9;  // °

void change_friction(scenario::Scenario& scenario, double by) {
  const auto change = [&](std::optional<double>& friction) {
    if (friction) friction = std::clamp(*friction + by, 0.0, steepest_friction);
  };
  const auto change_own = [&](scenario::JointKeys& joints) {
    change(joints.friction);
    joints.change_of_mapped_friction = by;
    auto& random = joints.random[static_cast<std::size_t>(rockmass::StrengthKey::friction)];
    if (!random) return;
    for (double* end : {&random->min, &random->max})
      *end = std::clamp(*end + by, 0.0, rockmass::most_friction);
    random->distribution.mean = std::max(0.0, random->distribution.mean + by);
  };
  if (!scenario.joints.friction) scenario.joints.friction = 0.0;
  change(scenario.joints.friction);
  for (auto& set : scenario.joint_sets) change_own(set.joints);
  for (auto& map : scenario.trace_maps) change_own(map.joints);
  if (scenario.rock_bridge) change(scenario.rock_bridge->joints.friction);
  for (auto& interface : scenario.interfaces) change(interface.joints.friction);
}

// The settling stages that an immediate release leaves out: [first, last).
std::pair<std::size_t, std::size_t> settling_after_excavation(const std::vector<Stage>& stages) {
  std::size_t first = 0;
  while (first < stages.size() && stages[first].excavate.empty()) ++first;
  std::size_t last = first;
  while (last < stages.size() && stages[last].kind == StageKind::settle) ++last;
  if (last == stages.size()) return {0, 0};
  return {first, last};
}

void release(std::vector<Stage>& stages) {
  const auto [first, last] = settling_after_excavation(stages);
  if (first == last) return;
  std::vector<int> all;
  std::vector<std::string> installed;
  for (std::size_t k = first; k <= last; ++k) {
    all.insert(all.end(), stages[k].excavate.begin(), stages[k].excavate.end());
    installed.insert(installed.end(), stages[k].install.begin(), stages[k].install.end());
  }
  stages[last].excavate = std::move(all);
  stages[last].install = std::move(installed);
  stages.erase(stages.begin() + static_cast<std::ptrdiff_t>(first),
               stages.begin() + static_cast<std::ptrdiff_t>(last));
}

/// s; what rocks or slides for longer is not waited for.
constexpr double longest_rest = 30.0;

void rest_until_still(std::vector<Stage>& stages) {
  Stage rest;
  rest.name = "until still";
  while (std::ranges::find(stages, rest.name, &Stage::name) != stages.end()) rest.name += " again";
  rest.kind = StageKind::rest;
  rest.duration = longest_rest;
  rest.until_still = true;
  stages.push_back(std::move(rest));
}

void leave_unshaken(scenario::Scenario& scenario, const std::string& since) {
  for (Stage& stage : scenario.stages)
    if (shakes_after(scenario, stage, since)) stage.scale = 0.0;
}

}  // namespace

bool shakes_after(const scenario::Scenario& scenario, const Stage& stage, const std::string& since) {
  const auto begin = std::ranges::find(scenario.stages, since, &Stage::name);
  const Stage* last_before = begin == scenario.stages.end() ? nullptr : &*begin;
  return stage.kind == StageKind::shake && (last_before == nullptr || &stage > last_before);
}

std::vector<std::string> variants_of(const scenario::Scenario& scenario,
                                     const std::vector<std::string>& compared) {
  std::vector<std::string> variants{"", "friction-", "friction+"};
  const auto [first, last] = settling_after_excavation(scenario.stages);
  const auto left_out = std::span(scenario.stages).subspan(first, last - first);
  const bool means_something = std::none_of(left_out.begin(), left_out.end(), [&](const Stage& stage) {
    return std::find(compared.begin(), compared.end(), stage.name) != compared.end();
  });
  if (first < last && means_something) variants.emplace_back("released");
  return variants;
}

void apply_variant(scenario::Scenario& scenario, const std::string& variant, const VariantTerms& terms) {
  if (variant.empty()) return;
  if (variant == "friction-") return change_friction(scenario, -terms.check.friction);
  if (variant == "friction+") return change_friction(scenario, terms.check.friction);
  if (variant == "released") return release(scenario.stages);
  if (variant == unshaken_variant) return leave_unshaken(scenario, terms.since);
  if (variant == still_variant) return rest_until_still(scenario.stages);
  throw std::invalid_argument("no variant '" + variant + "'");
}

std::string variant_identity(const std::string& variant, const VariantTerms& terms) {
  if (variant == unshaken_variant) return fmt::format("{}/{}", variant, terms.since);
  return variant.starts_with("friction") ? fmt::format("{}{}", variant, terms.check.friction) : variant;
}

}  // namespace keyblock::study
