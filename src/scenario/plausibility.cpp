#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rockmass/distribution.h"
#include "scenario/inputs.h"
#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using simulation::Stage;
using simulation::StageKind;

// Cutting off a distribution that moves its mean by more than this share is worth a warning.
constexpr double mean_tolerance = 0.01;

class Plausibility {
 public:
  explicit Plausibility(const Scenario& scenario) : scenario_(scenario) {}

  std::vector<std::string> warnings() {
    check_distributions();
    check_excavations();
    check_in_situ();
    check_stages();
    return std::move(warnings_);
  }

 private:
  template <class... Values>
  void warn(fmt::format_string<Values...> text, Values&&... values) {
    warnings_.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  void check_distributions() {
    for (const JointSetSpec& spec : scenario_.joint_sets) {
      const std::pair<const char*, const rockmass::Distribution*> lengths[] = {
          {"spacing", &spec.set.spacing}, {"length", &spec.set.length}, {"gap", &spec.set.gap}};
      for (const auto& [key, distribution] : lengths) {
        if (distribution->mean <= 0.0) continue;
        const double mean = rockmass::truncated_mean(*distribution);
        if (!(mean > (1.0 + mean_tolerance) * distribution->mean)) continue;
        warn("{}.{}: cut off at zero, its mean is {:.4g} instead of {:.4g}", spec.path, key, mean,
             distribution->mean);
      }
    }
  }

  void check_excavations() {
    for (std::size_t k = 0; k < scenario_.excavations.size(); ++k) {
      const ExcavationSpec& spec = scenario_.excavations[k];
      const int index = static_cast<int>(k);
      const bool taken_out =
          std::any_of(scenario_.stages.begin(), scenario_.stages.end(), [&](const Stage& stage) {
            return std::find(stage.excavate.begin(), stage.excavate.end(), index) != stage.excavate.end();
          });
      if (!taken_out && !scenario_.stages.empty()) warn("{}: no stage excavates it", spec.path);
      if (!scenario_.domain) continue;
      const Domain& domain = *scenario_.domain;
      const Box box{{domain.x.first, domain.y.first}, {domain.x.second, domain.y.second}};
      const Ring outline = excavation_outline(spec);
      if (!std::all_of(outline.begin(), outline.end(), [&](Vec2 p) { return box.contains(p); })) {
        warn("{}: reaches beyond the domain", spec.path);
      }
    }
  }

  void check_in_situ() {
    if (!scenario_.in_situ) return;
    const InSituSpec& in_situ = *scenario_.in_situ;
    if (in_situ.k0 && 3.0 * *in_situ.k0 < 1.0) {
      warn("in_situ.k0 = {}: below 1/3 the crown of a round opening is not compressed (3 K0 < 1)",
           *in_situ.k0);
    }
    if (!in_situ.depth && (in_situ.sxx > 0.0 || in_situ.syy > 0.0)) {
      warn("in_situ: a positive stress is tension");
    }
  }

  void check_stages() {
    if (scenario_.stages.empty()) {
      warn("no [[stage]]: there is nothing to run, only to cut");
      return;
    }
    bool settled = true;  // since the last excavation
    const Stage* before = nullptr;
    for (const Stage& stage : scenario_.stages) {
      const std::string path = join_path("stage", stage.name);
      if (!stage.excavate.empty()) settled = false;
      if (stage.kind == StageKind::settle) settled = true;
      if (stage.kind == StageKind::shake && !settled) {
        warn("{}: shakes before the rock has settled after an excavation", path);
      } else if (stage.kind == StageKind::shake && before != nullptr && before->kind == StageKind::settle &&
                 has_opening()) {
        warn(
            "{}: what hangs loose comes down during the shaking; a stage of kind \"rest\" before it tells "
            "the two "
            "apart",
            path);
      }
      before = &stage;
    }
    for (const MotionSpec& motion : scenario_.motions) {
      const int index = static_cast<int>(&motion - scenario_.motions.data());
      const bool used = std::any_of(scenario_.stages.begin(), scenario_.stages.end(),
                                    [&](const Stage& stage) { return stage.motion == index; });
      if (!used) warn("{}: no stage uses it", motion.path);
    }
  }

  [[nodiscard]] bool has_opening() const {
    return std::any_of(scenario_.stages.begin(), scenario_.stages.end(),
                       [](const Stage& stage) { return !stage.excavate.empty(); });
  }

  const Scenario& scenario_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> plausibility_warnings(const Scenario& scenario) {
  return Plausibility(scenario).warnings();
}

}  // namespace keyblock::scenario
