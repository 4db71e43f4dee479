#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rockmass/trace_generator.h"
#include "scenario/excavated_blocks.h"
#include "scenario/key_path.h"
#include "scenario/own_joints.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

// Mistakes that show only when several sections are seen together. Positions are those in the context, as the
// scenario has none yet.
class Consistency {
 public:
  Consistency(TableReader& root, const Scenario& scenario) : root_(root), scenario_(scenario) {}

  void check() {
    if (root_.documenting()) return;
    if (root_.find("domain") == nullptr) check_without_domain();
    const Value* section = root_.find("section");
    if (section == nullptr || section->find("azimuth") == nullptr) check_without_azimuth();
    check_trace_counts();
    check_tessellations();
    check_bridges();
    check_motion_places();
    check_weights();
    check_excavations();
    check_pressures(root_, scenario_);
  }

 private:
  /// Whether the list has any, were they wrong, or is no list at all: then that is the mistake that is told.
  bool has_elements(std::string_view key) const {
    const Value* list = root_.find(key);
    return list != nullptr && (!list->is(Value::Type::array) || !list->items.empty());
  }

  void fail(const std::string& path, std::string key, std::string found, std::string expected) {
    ReadContext& context = root_.context();
    context.mistakes.add({context.where(path), std::move(key), std::move(found), std::move(expected), ""});
  }

  void check_without_domain() {
    if (!scenario_.joint_sets.empty()) {
      fail(scenario_.joint_sets.front().path, "domain", "nothing", "[domain], which joint sets are made in");
    } else if (!scenario_.trace_maps.empty()) {
      fail(scenario_.trace_maps.front().path, "domain", "nothing", "[domain], which trace maps are cut in");
    } else if (scenario_.blocks.empty() && !has_elements("block") && !has_elements("block_map")) {
      root_.missing("domain", "[domain] or at least one [[block]] or [[block_map]]");
    }
  }

  void check_without_azimuth() {
    const std::string expected = "the direction of the +x axis, in degrees from north, which {} need";
    if (!scenario_.joint_sets.empty()) {
      fail(scenario_.joint_sets.front().path, "section.azimuth", "nothing",
           fmt::format(fmt::runtime(expected), "joint sets"));
      return;
    }
    for (const MotionSpec& motion : scenario_.motions) {
      const bool horizontal = std::any_of(motion.components.begin(), motion.components.end(),
                                          [](const auto& c) { return c.azimuth.has_value(); });
      if (!horizontal) continue;
      fail(motion.path, "section.azimuth", "nothing",
           fmt::format(fmt::runtime(expected), "horizontal components of records"));
      return;
    }
  }

  void check_trace_counts() {
    if (!scenario_.domain || !scenario_.section_azimuth) return;
    const Domain& domain = *scenario_.domain;
    if (domain.x.first >= domain.x.second || domain.y.first >= domain.y.second) return;
    const Box window = domain.box();
    for (const JointSetSpec& spec : scenario_.joint_sets) {
      const rockmass::JointSet& set = spec.set;
      if (set.spacing.mean <= 0.0 || set.length.mean <= 0.0) continue;
      const double count = rockmass::expected_traces(set, *scenario_.section_azimuth, window);
      if (!(count > rockmass::max_traces)) continue;
      fail(spec.path, join_path(spec.path, "spacing"),
           fmt::format("about {:.2g} traces in the domain", count),
           fmt::format("at most {:.0e}; spacing, length or gap are too small for this domain",
                       rockmass::max_traces));
    }
  }

  void check_tessellations() {
    for (const TraceMapSpec& spec : scenario_.trace_maps) {
      if (!spec.tessellation) continue;
      rockmass::Tessellation tessellation = *spec.tessellation;
      if (tessellation.region.empty() && scenario_.domain)
        tessellation.region = {scenario_.domain->box().min, scenario_.domain->box().max};
      const double count = rockmass::expected_count(tessellation);
      if (!(count > rockmass::most_of_tessellation)) continue;
      fail(spec.path, join_path(spec.path, "size"), fmt::format("about {:.2g} blocks", count),
           fmt::format("at most {:.0e}; blocks are too small for this region",
                       rockmass::most_of_tessellation));
    }
  }

  // Rock bridges have a strength, and a name that is theirs.
  void check_bridges() {
    const std::string expected = "[rock_bridge], with the strength of the rock that joints go on through";
    if (scenario_.rock_bridge) {
      for (const OwnJoints& joints : own_joints(scenario_)) {
        if (joints.name == scenario_.rock_bridge->name && joints.path != scenario_.rock_bridge->path)
          fail(joints.path, join_path(joints.path, "name"), "'rock_bridge', as [rock_bridge] is called",
               "a name of its own");
      }
      return;
    }
    if (scenario_.cutting.bridges_dead_ends)
      fail("cutting.dead_ends", "cutting.dead_ends", "\"bridge\" without [rock_bridge]", expected);
    for (const JointSetSpec& spec : scenario_.joint_sets) {
      const std::string key = join_path(spec.path, "gap_bonds");
      if (spec.gap_bonds) fail(key, key, "gap_bonds without [rock_bridge]", expected);
    }
  }

  // A rigid base does what the motion says; below a compliant one are waves.
  void check_motion_places() {
    const bool compliant = scenario_.boundary && scenario_.boundary->compliant;
    for (const MotionSpec& motion : scenario_.motions) {
      // A record within the ground moves a rigid base at its depth, too.
      if (!motion.place || compliant == (*motion.place != MotionPlace::base) ||
          (motion.place == MotionPlace::within && scenario_.boundary))
        continue;
      const std::string key = join_path(motion.path, "at");
      fail(key, key, compliant ? "\"base\" over a compliant base" : "a motion of waves over a rigid base",
           compliant ? "\"outcrop\", \"incident\" or \"within\", or [boundary] base = \"rigid\""
                     : "\"base\", or [boundary] with base = \"compliant\"");
    }
  }

  // Residuals are measured by what has to be carried. A load that was not understood may be that.
  void check_weights() {
    if (!root_.context().mistakes.empty() || has_weights()) return;
    const auto& stages = scenario_.stages;
    const auto settling = std::find_if(stages.begin(), stages.end(), [](const record::Stage& stage) {
      return stage.kind == record::StageKind::settle;
    });
    if (settling == stages.end()) return;
    const std::string key = join_path(join_path("stage", settling->name), "kind");
    fail(key, key, "\"settle\" without anything to carry",
         "gravity, a load, or a stress in [in_situ], by which equilibrium is measured");
  }

  [[nodiscard]] bool has_weights() const {
    const auto& in_situ = scenario_.in_situ;
    if (in_situ && (in_situ->sxx != 0.0 || in_situ->syy != 0.0 || in_situ->sxy != 0.0)) return true;
    const auto is_held = [](const ExcavationSpec& spec) {
      return !spec.pressure.empty() || !spec.pressure_by_stage.empty();
    };
    if (std::any_of(scenario_.excavations.begin(), scenario_.excavations.end(), is_held)) return true;
    return scenario_.gravity != Vec2{} ||
           std::any_of(scenario_.loads.begin(), scenario_.loads.end(), [&](const loading::Load& load) {
             const auto is_none = [&](double s) { return load.traction(s) == Vec2{}; };
             return !(is_none(0.0) && is_none(0.5) && is_none(1.0));
           });
  }

  // Outlines are cut into the domain, but not into explicit blocks: these are taken out whole or left. Shapes that were not
  // understood cannot be compared.
  void check_excavations() {
    if (!root_.context().mistakes.empty()) return;
    for (const ExcavationSpec& excavation : scenario_.excavations) {
      const Ring outline = excavation_outline(excavation);
      for (const BlockSpec& block : scenario_.blocks) {
        const Overlay over = overlay(block.polygon, outline);
        if (over.place == Place::outside || (over.place == Place::inside && !block.fixed)) continue;
        const std::string key = join_path(block.path, "outer");
        const std::string share =
            fmt::format("of which {:.3g} % lie in {}", 100.0 * over.share, excavation.path);
        if (block.fixed) {
          fail(key, key, "a fixed block, " + share,
               "an excavation beside it, as what is fixed is not taken out");
        } else {
          fail(key, key, "a block, " + share,
               "all or nothing of it, as blocks are taken out whole: two [[block]] in its place, along the "
               "outline");
        }
      }
    }
  }

  TableReader& root_;
  const Scenario& scenario_;
};

constexpr Word<bool> unit_sets[] = {{"SI", true}, {"other", false}};
constexpr std::pair<const char*, bool AcceptedWarnings::*> acceptable[] = {
    {"plane-stress", &AcceptedWarnings::plane_stress},
    {"order-1", &AcceptedWarnings::order_1},
    {"free-boundary", &AcceptedWarnings::free_boundary},
    {"step", &AcceptedWarnings::step},
    {"damping", &AcceptedWarnings::damping},
    {"closed-box", &AcceptedWarnings::closed_box},
    {"closed-ground", &AcceptedWarnings::closed_ground},
    {"late-falls", &AcceptedWarnings::late_falls},
    {"lost-joints", &AcceptedWarnings::lost_joints},
    {"loads", &AcceptedWarnings::loads},
    {"scale", &AcceptedWarnings::scale},
    {"window", &AcceptedWarnings::window},
    {"azimuth", &AcceptedWarnings::azimuth},
    {"direction", &AcceptedWarnings::direction},
    {"skipped", &AcceptedWarnings::skipped}};

constexpr KeyKind word_list[] = {KeyKind::references};
constexpr KeyKind gravity_kinds[] = {KeyKind::point, KeyKind::number};

void read_accepted_warnings(TableReader& root, AcceptedWarnings& accepted) {
  std::vector<std::string> words;
  for (const auto& [word, member] : acceptable) words.emplace_back(word);
  const std::string type = "array of " + list_words(words, ", ");
  const Value* list =
      root.any("accept_warnings", type,
               {.meaning = "Warnings of choices that are meant: they are not given ([which they "
                           "are](guide/scenarios.md#warnings)).",
                .fallback = "[]",
                .kinds = word_list});
  if (list == nullptr) return;
  if (!list->is(Value::Type::array)) {
    root.fail("accept_warnings", describe(*list), "an " + type,
              list->is(Value::Type::string) ? "write [" + to_toml(*list) + "]" : "");
    return;
  }
  for (std::size_t k = 0; k < list->items.size(); ++k) {
    const Value& item = list->items[k];
    const auto* found = std::find_if(std::begin(acceptable), std::end(acceptable), [&](const auto& known) {
      return item.is(Value::Type::string) && item.text == known.first;
    });
    if (found != std::end(acceptable)) {
      accepted.*(found->second) = true;
    } else {
      root.fail_at(item, join_index("accept_warnings", k), describe(item), list_words(words),
                   item.is(Value::Type::string) ? suggestion(item.text, words) : "");
    }
  }
}

void read_gravity(TableReader& root, Scenario& scenario) {
  Rule rule{.meaning = "Acceleration of gravity; a single number is that downwards.",
            .unit = "m/s²",
            .kinds = gravity_kinds,
            .usual = &usual::weight};
  const Value* given = root.find("gravity");
  if (root.documenting()) {
    rule.fallback = "[0, -9.81]";
    root.any("gravity", "point [x, y], or number of at least 0", rule);
  } else if (given != nullptr && given->is_number()) {
    double downwards = 0.0;
    rule.at_least = 0.0;
    if (root.number("gravity", downwards, rule)) scenario.gravity = {0.0, -downwards};
  } else {
    root.point("gravity", scenario.gravity, rule);
  }
  root.number(
      "tilt", scenario.tilt,
      {.meaning = "The whole model tilted, as on a tilting table: its right side goes up by this angle, and "
                  "gravity pulls to the left as well. Gravity alone is turned.",
       .unit = "°",
       .at_least = -180.0,
       .at_most = 180.0,
       .usual = &usual::angle});
  if (scenario.tilt == 0.0) return;
  const double angle = scenario.tilt * std::numbers::pi / 180.0;
  const Vec2 g = scenario.gravity;
  scenario.gravity = {std::cos(angle) * g.x + std::sin(angle) * g.y,
                      std::cos(angle) * g.y - std::sin(angle) * g.x};
}

}  // namespace

void read_scenario(TableReader& root, Scenario& scenario) {
  root.string("title", scenario.title, {.meaning = "Title of the report."});
  root.word("units", scenario.si_units, unit_sets,
            {.meaning = "Units of the file. `other`: any other consistent set, or values that are unusual on "
                        "purpose; no value is then compared with what is usual for rock in SI units."});
  read_accepted_warnings(root, scenario.accepted);
  root.integer("seed", scenario.seed,
               {.meaning = "Of the random numbers: the same seed and realization give the same joints on any "
                           "machine."});
  read_gravity(root, scenario);
  read_rock_mass(root, scenario);
  read_shapes(root, scenario);
  read_interfaces(root, scenario);
  read_boundary(root, scenario);
  read_loading(root, scenario);
  read_run(root, scenario);
  read_safety(root, scenario);
  read_study(root, scenario);
  Consistency(root, scenario).check();
  if (!root.documenting() && !scenario.study) keep_used_records(scenario);
  if (!root.documenting()) add_trial_stage(scenario);
}

}  // namespace keyblock::scenario
