#include "scenario/dynamic_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/damping.h"
#include "scenario/key_path.h"
#include "scenario/magnitudes.h"
#include "simulation/build_boundary.h"
#include "simulation/planned_changes.h"
#include "simulation/rock_sample.h"
#include "simulation/spring_blocks.h"

namespace keyblock::scenario {
namespace {

using record::Stage;
using record::StageKind;
using simulation::RunSetup;

constexpr double blocks_across = 4.0;  // across a box whose waves are missed
constexpr double most_share = 0.02;    // of critical, that a rule takes from a spring unnoticed
constexpr double good_share = 0.005;   // that the step advised leaves

bool is_dynamic(const RunSetup& setup) {
  return std::ranges::any_of(setup.stages, [](const Stage& s) { return s.kind != StageKind::settle; });
}

/// s, at which a component of the velocity may be largest: where the acceleration goes through zero, and samples.
std::vector<double> turning_times(const loading::GroundMotion& motion) {
  std::vector<double> times = motion.times();
  const auto& a = motion.accelerations();
  for (std::size_t k = 1; k < a.size(); ++k) {
    for (const auto& [from, to] : {std::pair{a[k - 1].x, a[k].x}, std::pair{a[k - 1].y, a[k].y}}) {
      if (from * to < 0.0)
        times.push_back(std::lerp(motion.times()[k - 1], motion.times()[k], from / (from - to)));
    }
  }
  return times;
}

double mass_of(const RunSetup& setup, std::size_t block) {
  return setup.properties[block].material.density * area(setup.system.blocks[block].polygon);
}

/// N per thickness, of rock that a stage takes out and none before it has.
double weight_taken_out(const RunSetup& setup, std::size_t stage) {
  double mass = 0.0;
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    if (setup.properties[b].fixed) continue;
    const std::vector<int>& inside = setup.system.blocks[b].excavations;
    const auto takes = [&](const Stage& s) {
      return std::ranges::find_first_of(inside, s.excavate) != inside.end();
    };
    const auto until = setup.stages.begin() + static_cast<std::ptrdiff_t>(stage);
    if (takes(*until) && std::none_of(setup.stages.begin(), until, takes)) mass += mass_of(setup, b);
  }
  return mass * norm(setup.gravity);
}

void warn_of_later_changes(const RunSetup& setup, std::vector<std::string>& warnings) {
  const auto change = simulation::last_planned_change(setup);
  if (!change) return;
  double end = 0.0;  // s; static stages take no time
  for (const Stage& stage : setup.stages) {
    if (stage.kind == StageKind::settle) continue;
    end +=
        stage.duration ? *stage.duration : setup.motions[static_cast<std::size_t>(stage.motion)].duration();
  }
  if (change->time <= end + setup.time_step) return;
  warnings.push_back(fmt::format("stage: the run ends at {:.4g} s, but {} changes until {:.4g} s", end,
                                 change->what, change->time));
}

void warn_of_closed_box(const Scenario& scenario, const RunSetup& setup, std::vector<std::string>& warnings) {
  const double stress = stress_left_out(setup);
  if (stress == 0.0 || scenario.accepted.closed_box) return;
  warnings.push_back(fmt::format(
      "domain.boundary{} = \"frame\": closed box: wave stress of {:.2g} MPa left out; a motion "
      "shakes the frame, and its waves neither press the rock nor leave it, so that less may fall "
      "than in the ground; [boundary] has the rock around",
      place_text(scenario, "domain.boundary"), stress / 1e6));
}

/// Damping in proportion to mass is against the ground far away, which waves move as well.
void warn_of_waves(const Scenario& scenario, const RunSetup& setup, std::vector<std::string>& warnings) {
  const auto& damping = setup.solver.damping;
  const bool shakes =
      std::ranges::any_of(setup.stages, [](const Stage& s) { return s.kind == StageKind::shake; });
  if (!damping || !shakes || scenario.accepted.damping || damping->kind == dynamics::DampingKind::stiffness)
    return;
  const double of_waves = std::numbers::pi * damping->frequency * damping->stiffness_time();
  warnings.push_back(fmt::format(
      "solver.damping{}: waves in the ground are damped by {:.3g} % at {:.4g} Hz, {} of what is asked: "
      "kind = \"{}\" damps blocks against the ground as well; for waves take kind = \"stiffness\"",
      place_text(scenario, "solver.damping"), 100.0 * of_waves, damping->frequency,
      of_waves > 0.0 ? "half" : "nothing", of_waves > 0.0 ? "rayleigh" : "mass"));
}

/// Springs and supports with the blocks that they hold, and what the rule takes from their swing.
class DampedSprings {
 public:
  explicit DampedSprings(const RunSetup& setup)
      : setup_(setup), rule_(dynamics::Integrator::of(setup.solver)) {
    for (std::size_t k = 0; k < setup.springs.size(); ++k) {
      const simulation::SpringBlocks blocks = simulation::spring_blocks(setup, k);
      const loading::Spring& spring = setup.springs[k];
      see(join_element("spring", spring.name, k), spring.stiffness,
          slowness(blocks.from) + slowness(blocks.to), dynamics::numerical_damping_of_spring);
    }
    for (std::size_t k = 0; k < setup.supports.size(); ++k) see_support(k);
  }

  void warn(std::vector<std::string>& warnings) const {
    if (worst_ <= most_share) return;
    const std::string others = count_ > 1 ? fmt::format(", and {} more like it", count_ - 1) : "";
    warnings.push_back(fmt::format(
        "{}: its block swings on it at {:.3g} Hz, where integrator = \"{}\" takes {:.2g} % of critical with "
        "steps of {:.3g} s{}; it holds what it should not, and where it yields too little; {}",
        path_, frequency_, name(), 100.0 * worst_, setup_.time_step, others, advice()));
  }

 private:
  [[nodiscard]] double slowness(std::size_t block) const {
    return setup_.properties[block].fixed ? 0.0 : 1.0 / mass_of(setup_, block);
  }
  void see_support(std::size_t k) {
    const loading::Support& support = setup_.supports[k];
    if (!support.stiffness) return;  // as stiff as the ground: nothing is to swing
    const auto block =
        std::ranges::find(setup_.properties, support.block, &simulation::BlockProperties::name);
    if (block == setup_.properties.end()) return;
    const double length = support.is_edge ? norm(support.points.back() - support.points.front())
                                          : static_cast<double>(support.points.size());
    see(join_element("support", support.name, k), *support.stiffness * length,
        slowness(static_cast<std::size_t>(block - setup_.properties.begin())), dynamics::numerical_damping);
  }
  using Damping = double (*)(const dynamics::Integrator&, double, double);
  void see(const std::string& path, double stiffness, double slowness, Damping damping) {
    if (!(stiffness > 0.0) || !(slowness > 0.0)) return;
    const double frequency = std::sqrt(stiffness * slowness) / (2.0 * std::numbers::pi),
                 share = damping(rule_, setup_.time_step, frequency);
    count_ += share > most_share ? 1 : 0;
    if (share <= worst_) return;
    worst_ = share;
    frequency_ = frequency;
    damping_ = damping;
    path_ = path;
  }
  [[nodiscard]] const char* name() const {
    switch (setup_.solver.integrator) {
      case dynamics::TimeIntegration::shi:
        return "shi";
      case dynamics::TimeIntegration::average_acceleration:
        return "average-acceleration";
      case dynamics::TimeIntegration::generalized_alpha:
        break;
    }
    return "generalized-alpha";
  }
  /// The longest step by halves that leaves it be, and the rule that does.
  [[nodiscard]] std::string advice() const {
    double step = setup_.time_step;
    for (int k = 0; k < 20 && damping_(rule_, step, frequency_) > good_share; ++k) step *= 0.5;
    const char* other = setup_.solver.integrator == dynamics::TimeIntegration::generalized_alpha
                            ? ""
                            : "integrator = \"generalized-alpha\", or ";
    return fmt::format("{}steps of {:.2g} s do not", other, step);
  }

  const RunSetup& setup_;
  dynamics::Integrator rule_;
  double worst_ = 0.0, frequency_ = 0.0;
  Damping damping_ = dynamics::numerical_damping;
  int count_ = 0;
  std::string path_;
};

}  // namespace

double stress_left_out(const RunSetup& setup) {
  if (!setup.frame) return 0.0;
  const Box box = simulation::boundary_box(setup);
  if (box.size().x < blocks_across * simulation::mean_block_size(setup)) return 0.0;
  double vx = 0.0, vy = 0.0;
  for (const Stage& stage : setup.stages) {
    if (stage.kind != StageKind::shake) continue;
    const auto k = static_cast<std::size_t>(stage.motion);
    const loading::GroundMotion& motion = setup.motions[k];
    const double end = stage.duration.value_or(motion.duration());
    for (const double time : turning_times(motion)) {
      if (time > end) continue;
      const Vec2 v = stage.scale * motion.velocity(time);
      vx = std::max(vx, std::abs(v.x));
      vy = std::max(vy, std::abs(v.y));
    }
  }
  if (vx == 0.0 && vy == 0.0) return 0.0;
  const auto rock = simulation::RockSample(setup, simulation::joint_pieces(setup), box).layer(box.max.y);
  return rock ? std::max(rock->impedance().x * vx, rock->impedance().y * vy) : 0.0;
}

std::vector<Diagnostic> dynamic_mistakes(const Scenario& scenario, const RunSetup& setup) {
  std::vector<Diagnostic> mistakes;
  if (!setup.boundary || !setup.boundary->compliant) return mistakes;
  const Vec2 size = simulation::boundary_box(setup).size();
  const double resistance =
      size.x * setup.boundary->dashpots.y + 2.0 * size.y * setup.boundary->layers.front().impedance().x;
  for (std::size_t s = 0; s < setup.stages.size(); ++s) {
    const Stage& stage = setup.stages[s];
    const double weight =
        stage.kind == StageKind::settle || stage.excavate.empty() ? 0.0 : weight_taken_out(setup, s);
    if (weight <= 0.0) continue;
    const std::string key = join_path(join_path("stage", stage.name), "excavate");
    mistakes.push_back(
        {scenario.where(key), key,
         fmt::format("{:.4g} kN/m of rock taken out while the base lets waves out; nothing would carry the "
                     "change, and the model would rise by some {:.2g} mm/s",
                     weight / 1e3, weight / resistance * 1e3),
         "a stage of kind \"settle\" that takes it out before", ""});
  }
  return mistakes;
}

void add_dynamic_warnings(const Scenario& scenario, const RunSetup& setup,
                          std::vector<std::string>& warnings) {
  warn_of_closed_box(scenario, setup, warnings);
  warn_of_later_changes(setup, warnings);
  warn_of_waves(scenario, setup, warnings);
  if (is_dynamic(setup) && !scenario.accepted.damping) DampedSprings(setup).warn(warnings);
}

}  // namespace keyblock::scenario
