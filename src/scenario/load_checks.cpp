#include "scenario/load_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenario/key_path.h"
#include "scenario/magnitudes.h"

namespace keyblock::scenario {
namespace {

using loading::Load;

/// Of the weight of its block: a load below moves nothing.
constexpr double least_share = 2e-3;
/// Of a traction that points out of the block, the share that pulls: what is steeper is meant as shear.
constexpr double least_pull = 0.1;
/// Of the largest side of the model, that something may be displaced by without a word.
constexpr double far_share = 0.2;

double largest_factor(const loading::TimeTable& factor) {
  if (factor.empty()) return 1.0;
  const auto largest =
      std::ranges::max_element(factor.rows(), {}, [](const auto& row) { return std::abs(row.second); });
  return largest->second;
}

const BlockSpec* block_of(const Scenario& scenario, const Load& load) {
  const auto found = std::ranges::find(scenario.blocks, load.block, &BlockSpec::name);
  return found == scenario.blocks.end() ? nullptr : &*found;
}

/// N per thickness.
double weight_of(const Scenario& scenario, const BlockSpec& block) {
  return block.rock.density.value_or(scenario.rock.density.value_or(0.0)) * area(block.polygon) *
         norm(scenario.gravity);
}

bool is_weak(const Scenario& scenario, const Load& load, const BlockSpec& block) {
  if (!scenario.si_units || scenario.accepted.loads) return false;
  const double force = norm(resultant(scenario, load));
  return force > 0.0 && force < least_share * weight_of(scenario, block);
}

class LoadChecks {
 public:
  LoadChecks(const Scenario& scenario, std::vector<std::string>& warnings)
      : scenario_(scenario), warnings_(warnings) {}

  void check() {
    for (std::size_t k = 0; k < scenario_.loads.size(); ++k) {
      const BlockSpec* block = block_of(scenario_, scenario_.loads[k]);
      if (block == nullptr) continue;
      check_strength(join_index("load", k), scenario_.loads[k], *block);
      check_direction(join_index("load", k), scenario_.loads[k], *block);
    }
    for (const BlockSpec& block : scenario_.blocks)
      if (block.fixed) check_way(join_path(block.path, "motion"), block.motion_x, block.motion_y);
    for (std::size_t k = 0; k < scenario_.supports.size(); ++k)
      check_way(join_path(join_element("support", scenario_.supports[k].name, k), "motion"),
                scenario_.supports[k].motion_x, scenario_.supports[k].motion_y);
    for (const record::Stage& stage : scenario_.stages) check_install(stage);
  }

 private:
  /// An empty list reads as "without supports", and means the contrary for those that no other stage installs.
  void check_install(const record::Stage& stage) {
    const std::string path = join_path(join_path("stage", stage.name), "install");
    const std::string place = place_text(scenario_, path);
    if (!stage.install.empty() || place.empty()) return;
    std::vector<std::string> there;
    for (const loading::Spring& spring : scenario_.springs) there.push_back(spring.name);
    for (const BoltSpec& spec : scenario_.bolts) there.push_back(spec.bolt.list);
    for (const LinerSpec& spec : scenario_.liners) there.push_back(spec.liner.name);
    std::erase_if(there, [&](const std::string& name) {
      const auto installs = [&](const record::Stage& other) {
        return std::ranges::find(other.install, name) != other.install.end();
      };
      return name.empty() || std::ranges::find(scenario_.absent, name) != scenario_.absent.end() ||
             std::ranges::any_of(scenario_.stages, installs);
    });
    if (there.empty()) return;
    warnings_.push_back(
        fmt::format("{}{}: installs nothing, and {} is there from the start, as no stage installs it; "
                    "present = false of a support leaves it out",
                    path, place, fmt::join(there, ", ")));
  }

  void check_strength(const std::string& path, const Load& load, const BlockSpec& block) {
    if (!is_weak(scenario_, load, block)) return;
    const double weight = weight_of(scenario_, block), force = norm(resultant(scenario_, load));
    const bool in_mega = 1e3 * force < least_share * weight;
    warnings_.push_back(
        fmt::format("{}{}: {:.3g} N/m, {:.2g} % of the weight of its block of {:.3g} kN/m; was it in {}{}? A "
                    "weaker load moves nothing",
                    path, place_text(scenario_, path), force, 100.0 * force / weight, weight / 1e3,
                    in_mega ? "M" : "k", load.is_line ? "Pa" : "N/m"));
  }

  /// Of a stretch of boundary; a force at a point may be that of an anchor.
  void check_direction(const std::string& path, const Load& load, const BlockSpec& block) {
    const Vec2 along = load.to - load.from, force = resultant(scenario_, load);
    if (!load.is_line || norm(along) == 0.0 || norm(force) == 0.0) return;
    const Vec2 unit = along / norm(along);
    Vec2 outwards{unit.y, -unit.x};
    const Vec2 beside = lerp(load.from, load.to, 0.5) + 1e-6 * norm(along) * outwards;
    if (contains(block.polygon, beside)) outwards = -outwards;
    if (dot(force, outwards) <= least_pull * norm(force)) return;
    warnings_.push_back(
        fmt::format("{}{}: pulls the face outwards by {:.3g} N/m; what lies against it, as earth or water, "
                    "pushes, with the other sign",
                    path, place_text(scenario_, path), dot(force, outwards)));
  }

  void check_way(const std::string& path, const loading::TimeTable& x, const loading::TimeTable& y) {
    const Vec2 size = box_of_model(scenario_).size();
    const double most = far_share * std::max(size.x, size.y);
    double way = 0.0;
    for (const loading::TimeTable* table : {&x, &y})
      if (!table->empty()) way = std::max(way, std::abs(largest_factor(*table)));
    if (way <= most) return;
    const bool cm = way / 1e2 <= most;
    warnings_.push_back(
        fmt::format("{}{}: goes {:.4g} m in a model of {:.4g} m; was it in {}? That is {:.4g} m", path,
                    place_text(scenario_, path), way, std::max(size.x, size.y), cm ? "cm" : "mm",
                    way / (cm ? 1e2 : 1e3)));
  }

  const Scenario& scenario_;
  std::vector<std::string>& warnings_;
};

}  // namespace

Vec2 resultant(const Scenario& scenario, const Load& load) {
  const double factor = scenario.load_factor * largest_factor(load.factor);
  if (!load.is_line) return factor * load.value;
  // Simpson's rule, exact for parabolas.
  const Vec2 sum = load.traction(0.0) + 4.0 * load.traction(0.5) + load.traction(1.0);
  return factor * norm(load.to - load.from) / 6.0 * sum;
}

bool is_weak_load(const Scenario& scenario, const std::string& key) {
  for (std::size_t k = 0; k < scenario.loads.size(); ++k) {
    const BlockSpec* block = block_of(scenario, scenario.loads[k]);
    if (block != nullptr && key.starts_with(join_index("load", k) + "."))
      return is_weak(scenario, scenario.loads[k], *block);
  }
  return false;
}

void add_load_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  if (!scenario.accepted.loads) LoadChecks(scenario, warnings).check();
}

}  // namespace keyblock::scenario
