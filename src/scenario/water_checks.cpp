#include "scenario/water_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/magnitudes.h"
#include "scenario/own_joints.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

/// m of water over the base of the model that nobody has in rock: heights may have been meant in other units.
constexpr double most_head = 2000.0;
/// Of a water table against the normal of gravity, that rounding leaves.
constexpr double least_tilt = 1e-6;

/// Of all joints of their own: they hold no water, whichever there is.
std::vector<bool> dry_by_themselves(const Scenario& scenario) {
  std::vector<bool> is_dry;
  for (const OwnJoints& joints : own_joints(scenario)) is_dry.push_back(joints.keys.dry);
  return is_dry;
}

class WaterChecks {
 public:
  WaterChecks(const Scenario& scenario, std::vector<std::string>& warnings)
      : scenario_(scenario), warnings_(warnings), box_(box_of_model(scenario)) {}

  void check() {
    for (std::size_t k = 0; k < scenario_.waters.size(); ++k) {
      check_height(scenario_.waters[k]);
      check_used(static_cast<int>(k));
      check_holders(scenario_.waters[k]);
    }
    check_gravity();
    for (const ExcavationSpec& spec : scenario_.excavations) check_drainage(spec);
    for (const OwnJoints& joints : own_joints(scenario_)) check_dry(joints.path, joints.keys);
  }

 private:
  template <class... Values>
  void warn(fmt::format_string<Values...> text, Values&&... values) {
    warnings_.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  /// m, the largest over the base of the model, where it is deepest: between the points of the table it is straight.
  [[nodiscard]] double largest_head(const WaterSpec& spec) const {
    const loading::WaterTable table(spec.table);
    double most = std::max(table.height(box_.min.x), table.height(box_.max.x));
    for (const Vec2 p : spec.table)
      if (p.x > box_.min.x && p.x < box_.max.x) most = std::max(most, p.y);
    return most - box_.min.y;
  }

  void check_height(const WaterSpec& spec) {
    const double head = largest_head(spec);
    const std::string place = place_text(scenario_, spec.path);
    if (head <= 0.0) {
      warn("{}{}: lies below all of the model, whose base is at {:.6g} m; nothing is wet", spec.path, place,
           box_.min.y);
    } else if (scenario_.si_units && head > most_head) {
      warn("{}{}: stands {:.4g} m above the base of the model; heights are in m", spec.path, place, head);
    }
  }

  // The first one acts until a stage says otherwise.
  void check_used(int k) {
    const auto uses = [&](const record::Stage& stage) { return stage.water == k; };
    const bool is_first = k == 0 && (scenario_.stages.empty() || !scenario_.stages.front().water);
    if (is_first || std::ranges::any_of(scenario_.stages, uses) ||
        std::ranges::any_of(scenario_.left_out, uses))
      return;
    warn("{}: no stage uses it", scenario_.waters[static_cast<std::size_t>(k)].path);
  }

  // Blocks that are given one by one hold it as well.
  void check_holders(const WaterSpec& spec) {
    if (!scenario_.blocks.empty()) return;
    std::vector<bool> is_dry = dry_by_themselves(scenario_);
    for (std::size_t k = 0; k < is_dry.size(); ++k) {
      if (is_dry[k] && spec.sets && (*spec.sets)[k])
        warn("{}.sets: names joints that are dry = true, which holds", spec.path);
      is_dry[k] = is_dry[k] || (spec.sets && !(*spec.sets)[k]);
    }
    if (!is_dry.empty() && std::ranges::find(is_dry, false) == is_dry.end())
      warn("{}: all joint sets, trace maps and interfaces are dry; no joint is wet", spec.path);
  }

  // Water at rest is level, and level is normal to gravity.
  void check_gravity() {
    const Vec2 g = scenario_.gravity;
    if (scenario_.waters.empty() || std::abs(g.x) <= least_tilt * norm(g)) return;
    warn(
        "{}: gravity is not straight down, by tilt or gravity = [{:.4g}, {:.4g}]; a table that is level in "
        "the "
        "drawing is no water at rest then. One that is has a slope of {:.4g}",
        scenario_.waters.front().path, g.x, g.y, -g.x / g.y);
  }

  void check_drainage(const ExcavationSpec& spec) {
    if (scenario_.waters.empty()) {
      if (spec.filled.value_or(false)) warn("{}.filled: there is no [water] to fill it", spec.path);
      return;
    }
    double deepest = 0.0;
    for (const WaterSpec& water : scenario_.waters) {
      const loading::WaterTable table(water.table);
      for (const Vec2 p : excavation_outline(spec)) deepest = std::max(deepest, table.head(p));
    }
    if (!spec.filled && deepest > 0.0)
      warn(
          "{}: lies up to {:.4g} m below the water, and its wall counts as drained; filled = false says that "
          "this is meant, filled = true that it stands full of water",
          spec.path, deepest);
  }

  void check_dry(const std::string& path, const JointKeys& joints) {
    if (joints.dry && scenario_.waters.empty()) warn("{}.dry: there is no [water]", path);
  }

  const Scenario& scenario_;
  std::vector<std::string>& warnings_;
  Box box_;
};

}  // namespace

void add_water_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  WaterChecks(scenario, warnings).check();
}

std::vector<simulation::Water> waters_of(const Scenario& scenario, Vec2 origin) {
  const std::vector<bool> is_dry = dry_by_themselves(scenario);
  std::vector<simulation::Water> waters;
  for (const WaterSpec& spec : scenario.waters) {
    std::vector<Vec2> table = spec.table;
    for (Vec2& p : table) p -= origin;
    std::vector<bool> dry = is_dry;
    for (std::size_t k = 0; spec.sets && k < dry.size(); ++k) dry[k] = dry[k] || !(*spec.sets)[k];
    waters.push_back({spec.name, loading::WaterTable(std::move(table)), spec.density, std::move(dry)});
  }
  return waters;
}

}  // namespace keyblock::scenario
