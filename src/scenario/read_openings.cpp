// How excavations are opened and held: keys of [[stage]] and [[excavation]].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using record::Stage;

constexpr double not_open = -1.0;

bool contains(const std::vector<int>& numbers, std::size_t number) {
  return std::ranges::find(numbers, static_cast<int>(number)) != numbers.end();
}

/// Reads `release` of a stage, after what it excavates and before it is one of the scenario.
class ReleaseReader {
 public:
  ReleaseReader(TableReader& t, Stage& stage, const Scenario& scenario)
      : t_(t), stage_(stage), before_(scenario.excavations.size(), not_open) {
    for (const ExcavationSpec& spec : scenario.excavations) names_.push_back(spec.name);
    for (const Stage& earlier : scenario.stages) {
      for (const int e : earlier.excavate) set(e, 1.0);
      for (const auto& [e, share] : earlier.release) set(e, share);
    }
    for (const int e : stage.excavate) set(e, 0.0);
  }

  /// in_parts: the number of parts is given.
  void read(const Value* value, bool in_parts) {
    if (value == nullptr) {
      if (in_parts) read_all(1.0, nullptr);
    } else if (value->is(Value::Type::table)) {
      read_table(*value);
    } else if (is_share(*value, t_.path() + ".release", "or a table of these by excavation")) {
      read_all(value->number, value);
    }
    // An opening of its whole release at once keeps no forces.
    std::erase_if(stage_.release, [&](const auto& of) {
      return of.second == 1.0 && !in_parts && contains(stage_.excavate, static_cast<std::size_t>(of.first));
    });
    std::ranges::sort(stage_.release);
    if (in_parts && stage_.release.empty() && !has_mistake_)
      t_.fail("release_steps", "parts of nothing", "an excavation that the stage opens or releases further");
  }

 private:
  template <typename... Texts>
  void fail_at(const Value& value, const std::string& path, Texts... texts) {
    has_mistake_ = true;
    t_.fail_at(value, path, texts...);
  }
  void set(int excavation, double share) { before_.at(static_cast<std::size_t>(excavation)) = share; }

  bool is_share(const Value& value, const std::string& path, const char* else_what) {
    if (value.is_number() && value.number >= 0.0 && value.number <= 1.0) return true;
    fail_at(value, path, describe(value),
            fmt::format("a number from 0 to 1{}{}", *else_what ? ", " : "", else_what));
    return false;
  }

  void add(std::size_t e, double share, const Value* value, const std::string& path) {
    if (share < before_[e]) {
      fail_at(*value, path, fmt::format("{} for the excavation '{}'", share, names_[e]),
              fmt::format("at least {}, which an earlier stage has released", before_[e]));
      return;
    }
    stage_.release.emplace_back(static_cast<int>(e), share);
  }

  void read_all(double share, const Value* value) {
    bool any = false;
    for (std::size_t e = 0; e < before_.size(); ++e) {
      if (before_[e] == not_open || before_[e] == 1.0) continue;
      any = true;
      add(e, share, value, t_.path() + ".release");
    }
    if (!any && value != nullptr)
      fail_at(*value, t_.path() + ".release", fmt::format("{} of nothing", share),
              "a stage that excavates, or one after an excavation that is released in part");
  }

  void read_table(const Value& table) {
    for (const Value& item : table.items) {
      const std::string path = join_path(t_.path() + ".release", item.key);
      const auto found = std::ranges::find(names_, item.key);
      if (found == names_.end()) {
        fail_at(item, path, fmt::format("\"{}\"", item.key),
                fmt::format("the name of a [[excavation]]: {}", list_words(names_)),
                suggestion(item.key, names_));
        continue;
      }
      const auto e = static_cast<std::size_t>(found - names_.begin());
      if (before_[e] == not_open) {
        fail_at(item, path, fmt::format("\"{}\", which is not open", item.key),
                "an excavation that this stage or an earlier one takes out");
      } else if (is_share(item, path, "")) {
        add(e, item.number, &item, path);
      }
    }
  }

  TableReader& t_;
  Stage& stage_;
  std::vector<double> before_;  ///< per excavation, released before the stage
  std::vector<std::string> names_;
  bool has_mistake_ = false;
};

constexpr KeyKind share_kinds[] = {KeyKind::number, KeyKind::numbers};
constexpr KeyKind pressure_kinds[] = {KeyKind::number, KeyKind::rows, KeyKind::numbers};
constexpr std::string_view pressure_type = "number, rows [[time, value], …], or table of numbers by stage";

bool is_pressure(const Value& value) {
  return value.is_number() && std::isfinite(value.number) && value.number >= 0.0;
}

void read_pressure_over_time(TableReader& t, ExcavationSpec& spec, const Rule& rule) {
  TimeRows rows;
  if (!t.time_rows("pressure", rows, false, rule)) return;
  const auto below = std::ranges::find_if(rows, [](const auto& row) { return row.second < 0.0; });
  if (below != rows.end()) {
    t.fail("pressure", fmt::format("the number {}", below->second), "pressures of at least 0, in Pa");
    return;
  }
  spec.pressure.over_time = loading::TimeTable(std::move(rows));
}

void read_pressure_over_stages(TableReader& t, ExcavationSpec& spec, const Value& table) {
  for (const Value& item : table.items) {
    const std::string path = join_path(join_path(t.path(), "pressure"), item.key);
    t.context().positions[path] = item.key_where;
    if (is_pressure(item)) {
      spec.pressure_by_stage.emplace_back(item.key, item.number);
      t.judge(item, path, item.number, &usual::wall_pressure);
    } else {
      t.fail_at(item, path, describe(item), "a number of at least 0, in Pa");
    }
  }
  if (table.items.empty()) t.fail("pressure", "an empty table", "a " + std::string(pressure_type));
}

}  // namespace

void read_release(TableReader& t, Stage& stage, bool settles, const Scenario& scenario) {
  Rule rule{.meaning =
                "Share of the forces of the excavated rock that acts no more at the end of the stage; "
                "the rest holds the wall. For all that is not released yet, or by excavation: "
                "`{ heading = 1.0, bench = 0.4 }`. It stays until a later stage raises it.",
            .fallback = "1 of what the stage excavates",
            .applies = settles,
            .condition = "kind = \"settle\"",
            .kinds = share_kinds};
  const Value* value = t.any("release", "number from 0 to 1, or table of these by excavation", rule);
  rule = {.meaning =
              "Equal parts in which it is released, each to equilibrium. Given, they count for a release of "
              "1, too.",
          .at_least = 1.0,
          .at_most = 10000.0,
          .fallback = "10; 1 for what is opened with a release of 1",
          .applies = settles,
          .condition = "kind = \"settle\""};
  std::optional<int> steps;
  const bool in_parts = t.integer("release_steps", steps, rule);
  if (steps) stage.release_steps = *steps;
  if (!t.documenting() && settles) ReleaseReader(t, stage, scenario).read(value, in_parts);
}

void read_pressure(TableReader& t, ExcavationSpec& spec) {
  const Rule rule{
      .meaning =
          "Support pressure on the wall, once the excavation is open: the same always, over time (linear "
          "between rows, held outside), or `{ heading = 50e3, bench = 0.0 }` from each of these "
          "stages on. It presses across the wall as it lies at the moment.",
      .unit = "Pa",
      .fallback = "0",
      .kinds = pressure_kinds,
      .usual = &usual::wall_pressure};
  const Value* value = t.find("pressure");
  if (value != nullptr && value->is(Value::Type::array)) {
    read_pressure_over_time(t, spec, rule);
  } else if (t.any("pressure", pressure_type, rule) != nullptr) {
    if (value->is(Value::Type::table)) {
      read_pressure_over_stages(t, spec, *value);
    } else if (is_pressure(*value)) {
      spec.pressure.constant = value->number;
      t.judge(*value, join_path(t.path(), "pressure"), value->number, rule.usual);
    } else {
      t.fail("pressure", describe(*value), "a " + std::string(pressure_type) + ", of at least 0, in Pa");
    }
  }
  const bool has_arc =
      t.interval("arc", spec.pressure.arc,
                 {.meaning = "Part of the wall that it acts on: angles about the centroid of "
                             "the outline, counter-clockwise from +x.",
                  .unit = "°",
                  .fallback = "all of the wall",
                  .applies = t.documenting() || value != nullptr,
                  .condition = "pressure"});
  if (!has_arc) return;
  const auto [from, to] = *spec.pressure.arc;
  if (to - from > 360.0 || std::abs(from) > 720.0 || std::abs(to) > 720.0)
    t.fail("arc", fmt::format("[{}, {}]", from, to), "angles within one turn, such as [30, 150]");
}

void check_pressures(TableReader& root, const Scenario& scenario) {
  ReadContext& context = root.context();
  std::vector<std::string> names;
  for (const Stage& stage : scenario.stages) names.push_back(stage.name);
  for (std::size_t e = 0; e < scenario.excavations.size(); ++e) {
    const ExcavationSpec& spec = scenario.excavations[e];
    const auto opens = std::ranges::find_if(scenario.stages,
                                            [&](const Stage& stage) { return contains(stage.excavate, e); });
    for (const auto& [name, pressure] : spec.pressure_by_stage) {
      const std::string path = join_path(join_path(spec.path, "pressure"), name);
      const auto found = std::ranges::find(names, name);
      if (found == names.end()) {
        context.mistakes.add({context.where(path), path, fmt::format("\"{}\"", name),
                              names.empty() ? "the name of a [[stage]] (there is none)"
                                            : fmt::format("the name of a [[stage]]: {}", list_words(names)),
                              suggestion(name, names)});
      } else if (found - names.begin() < opens - scenario.stages.begin()) {
        context.mistakes.add({context.where(path), path, fmt::format("\"{}\"", name),
                              fmt::format("the stage that excavates '{}', or a later one", spec.name), ""});
      }
    }
  }
}

simulation::SupportPressure pressure_of(const Scenario& scenario, const ExcavationSpec& spec) {
  simulation::SupportPressure pressure = spec.pressure;
  for (const auto& [name, value] : spec.pressure_by_stage) {
    const auto stage = std::ranges::find(scenario.stages, name, &Stage::name);
    pressure.over_stages.emplace_back(static_cast<int>(stage - scenario.stages.begin()), value);
  }
  std::ranges::sort(pressure.over_stages);
  return pressure;
}

}  // namespace keyblock::scenario
