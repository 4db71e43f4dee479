// Water in joints: [water] and [[water]].
#include <fmt/format.h>

#include <algorithm>

#include "scenario/key_path.h"
#include "scenario/own_joints.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr KeyKind name_list[] = {KeyKind::references};

void read_sets(TableReader& t, WaterSpec& water, const Scenario& scenario) {
  constexpr std::string_view type = "array of names of [[joint_set]], [[interface]] and [[trace_map]]";
  const Value* list =
      t.any("sets", type,
            {.meaning = "The joint sets, interfaces and trace maps that hold this water; the others are dry. "
                        "Outside faces hold it always.",
             .fallback = "all but those with dry = true",
             .kinds = name_list});
  if (list == nullptr) return;
  if (!list->is(Value::Type::array)) {
    t.fail("sets", describe(*list), "an " + std::string(type),
           list->is(Value::Type::string) ? "write [" + to_toml(*list) + "]" : "");
    return;
  }
  const std::vector<std::string> names = names_of(own_joints(scenario));
  water.sets.emplace(names.size(), false);
  for (std::size_t k = 0; k < list->items.size(); ++k) {
    const Value& item = list->items[k];
    const auto found = item.is(Value::Type::string) ? std::ranges::find(names, item.text) : names.end();
    if (found != names.end()) {
      (*water.sets)[static_cast<std::size_t>(found - names.begin())] = true;
      continue;
    }
    t.fail_at(item, join_index(join_path(t.path(), "sets"), k), describe(item),
              names.empty()
                  ? "the name of a [[joint_set]], [[interface]] or [[trace_map]] (there is none)"
                  : "the name of a [[joint_set]], [[interface]] or [[trace_map]]: " + list_words(names),
              item.is(Value::Type::string) ? suggestion(item.text, names) : "");
  }
}

void check_table(TableReader& t, const std::vector<Vec2>& table) {
  if (table.size() < 2) {
    t.fail("table", "one point", "at least two points [[x, y], …], or head = y for water that stands level");
    return;
  }
  for (std::size_t k = 1; k < table.size(); ++k) {
    if (table[k].x > table[k - 1].x) continue;
    t.fail("table", fmt::format("x = {} after x = {}", table[k].x, table[k - 1].x),
           "points from left to right: x that ascends");
    return;
  }
}

void read_one(TableReader& t, WaterSpec& water, bool is_alone, const Scenario& scenario) {
  water.path = t.path();
  const bool documenting = t.documenting();
  t.name("name", water.name, "water",
         {.meaning = "Name, for the stages that choose it. Required where there are several.",
          .required = !is_alone && !documenting,
          .fallback = "none"});
  if (water.name == no_water)
    t.fail("name", fmt::format("\"{}\"", no_water), "another name, as stages say so for no water at all");
  t.number("density", water.density,
           {.meaning = "Density of the water. The density of rock under it is that of wet rock.",
            .unit = "kg/m³",
            .required = !scenario.si_units && !documenting,
            .above = 0.0,
            .usual = &usual::water_density});
  const bool has_table = t.find("table") != nullptr, has_head = t.find("head") != nullptr;
  const bool given =
      t.points("table", water.table,
               {.meaning = "Water table, or piezometric line: its height over x, from left to "
                           "right. Straight between points, level beyond the first and the last. "
                           "`table` or `head` is required.",
                .unit = "m",
                .fallback = "head"});
  std::optional<double> head;
  t.number("head", head,
           {.meaning = "Height of water that stands level, in the place of a table.",
            .unit = "m",
            .fallback = "table"});
  if (documenting) return read_sets(t, water, scenario);
  if (has_table && has_head) t.fail("head", "a head and a table", "one of the two");
  if (!has_table && !has_head) t.missing("table", "table = [[x, y], …] or head = y");
  if (given) check_table(t, water.table);
  if (head) water.table = {{0.0, *head}};
  read_sets(t, water, scenario);
  if (scenario.gravity.y >= 0.0)
    t.fail(has_table ? "table" : "head", "water without gravity downwards",
           "gravity = [x, y] with y below 0, which gives water its pressure");
}

}  // namespace

void read_water(TableReader& root, Scenario& scenario) {
  const Value* given = root.find("water");
  const bool is_alone = given == nullptr || !given->is(Value::Type::array) || given->items.size() < 2;
  root.tables("water", scenario.waters,
              {.meaning = "Water at rest in joints and around blocks: `[water]`, or `[[water]]` where stages "
                          "choose of several. Its pressure acts from the first stage on.",
               .may_be_alone = true},
              [&](TableReader& t, WaterSpec& water) { read_one(t, water, is_alone, scenario); });
}

void read_water_of_stage(TableReader& t, record::Stage& stage, const Scenario& scenario) {
  std::string name;
  if (!t.reference("water", name, "water",
                   {.meaning = "The water that acts from this stage on, `none` for none.",
                    .fallback = "as before; at the start the first [[water]]"},
                   no_water))
    return;
  const auto found = std::ranges::find(scenario.waters, name, &WaterSpec::name);
  stage.water = name == no_water ? -1 : static_cast<int>(found - scenario.waters.begin());
}

}  // namespace keyblock::scenario
