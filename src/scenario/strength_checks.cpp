#include "scenario/strength_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "scenario/own_joints.h"

namespace keyblock::scenario {
namespace {

/// The strength of [joints], or of joints of their own: what it gives itself, and what it has with that of [joints].
class Strength {
 public:
  Strength(const std::string& path, const JointKeys& own, const JointKeys& standard,
           std::vector<std::string>& warnings)
      : path_(path), own_(own), standard_(standard), warnings_(warnings) {}

  // Where the line of Coulomb ends, at tension c / tan φ, a joint in place has no shear strength left.
  void check_bond() {
    const bool gives_bond = own_.tension || own_.cohesion;
    if (!gives_bond && !own_.friction) return;
    if (tension() > 0.0 && cohesion() == 0.0) {
      if (gives_bond)
        warn("{}: tension without cohesion holds nothing, as the least shear breaks the joint", path_);
      return;
    }
    const double apex = cohesion() / std::tan(friction() * std::numbers::pi / 180.0);
    if (tension() > apex)
      warn(
          "{}: the least shear breaks a joint pulled by cohesion / tan(friction), {:.4g}, before its tension "
          "of {:.4g} is reached",
          path_, apex, tension());
  }

  void check_residual() {
    const bool falls = cohesion() > 0.0 || tension() > 0.0 ||
                       of(&JointKeys::residual_friction).value_or(friction()) < friction();
    if (own_.has_residual() && !falls)
      warn(
          "{}: nothing falls to residual strength, as residual_friction is not below friction and there is "
          "neither cohesion nor tension",
          path_);
    const double left = of(&JointKeys::residual_cohesion).value_or(0.0);
    const bool is_inherited = own_.cohesion && !own_.residual_cohesion && left > 0.0;
    if (is_inherited && left != cohesion())
      warn(
          "{}: cohesion {} has the residual_cohesion of [joints], {}{}; give the set its own, {} if slip "
          "takes none of it",
          path_, cohesion(), left, left > cohesion() ? ", of which it can keep no more than it has" : "",
          cohesion());
  }

  // Bonds break one after another where the equilibrium is one of a whole joint.
  void check_factor() {
    const bool is_reduced = of(&JointKeys::strength_factor).has_value(),
               gives_cohesion = own_.cohesion.has_value();
    if (is_reduced && gives_cohesion && cohesion() > 0.0 && !of(&JointKeys::residual_cohesion))
      warn(
          "{}: its cohesion is lost contact by contact, so that a factor of safety comes out 10 to 50 % too "
          "low; "
          "residual_cohesion = {} keeps it, as limit equilibrium does",
          path_, cohesion());
  }

 private:
  [[nodiscard]] std::optional<double> of(std::optional<double> JointKeys::*key) const {
    return own_.*key ? own_.*key : standard_.*key;
  }
  [[nodiscard]] double friction() const { return of(&JointKeys::friction).value_or(0.0); }
  [[nodiscard]] double cohesion() const { return of(&JointKeys::cohesion).value_or(0.0); }
  [[nodiscard]] double tension() const { return of(&JointKeys::tension).value_or(0.0); }
  template <typename... Values>
  void warn(fmt::format_string<Values...> text, Values&&... values) {
    warnings_.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  const std::string& path_;
  const JointKeys &own_, &standard_;
  std::vector<std::string>& warnings_;
};

}  // namespace

void add_strength_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  static const JointKeys nothing;
  const auto for_all = [&](void (Strength::*check)()) {
    static const std::string joints = "joints";
    (Strength(joints, scenario.joints, nothing, warnings).*check)();
    for (const OwnJoints& own : own_joints(scenario))
      (Strength(own.path, own.keys, scenario.joints, warnings).*check)();
  };
  for (const auto check : {&Strength::check_bond, &Strength::check_residual, &Strength::check_factor})
    for_all(check);
}

}  // namespace keyblock::scenario
