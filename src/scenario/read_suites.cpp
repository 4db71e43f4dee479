#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.h"
#include "loading/intensity.h"
#include "scenario/key_path.h"
#include "scenario/motion_words.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr Word<bool> orientation_words[] = {{"as-recorded", false}, {"random", true}};
constexpr Word<bool> suite_window_words[] = {{"whole", false}, {"significant", true}};
constexpr Word<MotionPlace> suite_places[] = {
    {"outcrop", MotionPlace::outcrop}, {"incident", MotionPlace::incident}, {"base", MotionPlace::base}};
constexpr std::string_view component_words[] = {"rotd50",          "rotd100", "geometric-mean",
                                                "arithmetic-mean", "larger",  "section"};
constexpr std::string_view of_section[] = {"PGA", "PGV", "IA"};

/// What all records of a suite have.
struct SuiteOfMotions {
  MotionSpec motion;
  bool has_vertical = true;
};

MotionComponentSpec component_of(const std::filesystem::path& file, std::optional<double> azimuth,
                                 bool vertical, const std::string& path) {
  MotionComponentSpec component;
  component.file = file;
  component.vertical = vertical;
  component.azimuth = azimuth;
  component.path = path;
  return component;
}

void add_motions(const SuiteSpec& suite, const SuiteOfMotions& common, Scenario& scenario,
                 std::vector<std::string>& names) {
  for (std::size_t k = 0; k < suite.records.size(); ++k) {
    const loading::SuiteRecord& record = suite.records[k];
    MotionSpec motion = common.motion;
    motion.name = suite.motion_name(k);
    motion.path = join_path(suite.path, record.name);
    motion.suite = static_cast<int>(scenario.suites.size());
    const auto add = [&](const std::filesystem::path& file, std::optional<double> azimuth, bool vertical,
                         const char* key) {
      if (!file.empty())
        motion.components.push_back(component_of(file, azimuth, vertical, join_path(motion.path, key)));
    };
    add(record.h1, record.azimuth1, false, "h1");
    add(record.h2, record.azimuth2, false, "h2");
    if (common.has_vertical) add(record.up, std::nullopt, true, "up");
    names.push_back(motion.name);
    scenario.motions.push_back(std::move(motion));
  }
}

void read_suite(TableReader& t, SuiteSpec& suite, SuiteOfMotions& common) {
  suite.path = t.path();
  t.name("name", suite.name, "suite",
         {.meaning = "Name; its records are the motions `NAME/RECORD`.", .required = true});
  const bool given =
      t.file("file", suite.file,
             {.meaning = "List of the records: a table with the columns name, h1, h2, up, azimuth1, "
                         "azimuth2, event, scale, "
                         "magnitude, distance_km, vs30_m_s, pulse_period_s; or `_SearchResults.csv` of PEER "
                         "([suites](suites.md)).",
              .required = true});
  t.word("orientation", common.motion.turned, orientation_words,
         {.meaning =
              "`as-recorded`: by the azimuths of the components. `random`: each record is turned about the "
              "vertical, by an angle that is drawn for each realization and record."});
  t.boolean("vertical", common.has_vertical, {.meaning = "Whether the vertical components shake as well."});
  t.word("window", common.motion.significant, suite_window_words,
         {.meaning =
              "`whole`: all of each record. `significant`: from 5 s before 0.1 % to 5 s after 99.9 % of the "
              "Arias intensity of its components."});
  t.word("baseline", common.motion.baseline, baseline_words, {.meaning = "As in [[motion]]."});
  t.word("at", common.motion.place, suite_places,
         {.meaning = "As in [[motion]].", .fallback = "\"outcrop\" over a compliant base, else \"base\""});
  if (!given || t.documenting()) return;
  try {
    suite.records = loading::read_suite_list(suite.file);
  } catch (const InputError& error) {
    t.context().mistakes.add(error.diagnostics());
  }
}

void check_component(TableReader& t, const ShakingSpec& shaking, const Scenario& scenario) {
  const auto is_one = [&](const auto& words, const std::string& word) {
    return std::find(std::begin(words), std::end(words), word) != std::end(words);
  };
  if (!is_one(component_words, shaking.component)) {
    t.fail("component", describe(*t.find("component")), fmt::format("{}", fmt::join(component_words, ", ")));
  } else if (shaking.component == "section") {
    if (!is_one(of_section, shaking.intensity))
      t.fail("component", fmt::format("\"section\" of {}", shaking.intensity),
             "PGA, PGV or IA in the section");
  } else if (shaking.suite >= 0) {
    for (const loading::SuiteRecord& record :
         scenario.suites[static_cast<std::size_t>(shaking.suite)].records) {
      if (!record.h2.empty()) continue;
      t.fail(t.find("component") == nullptr ? "suite" : "component",
             fmt::format("{} with the record '{}', which has one horizontal component", shaking.component,
                         record.name),
             "records of two, or component = \"section\"");
      return;
    }
  }
}

void read_numbers(TableReader& t, std::string_view key, std::vector<double>& numbers, const Rule& rule) {
  const Value* list = t.any(key, "array of ascending numbers above 0", rule);
  if (list == nullptr) return;
  const std::string expected = "an array of ascending numbers above 0";
  if (!list->is(Value::Type::array) || list->items.empty()) return t.fail(key, describe(*list), expected);
  for (const Value& item : list->items) {
    if (!item.is_number() || !(item.number > (numbers.empty() ? 0.0 : numbers.back())))
      return t.fail_at(item, join_path(t.path(), key), describe(item), expected);
    numbers.push_back(item.number);
  }
}

/// Names of stages that shake; all of them where none is given.
void read_stages_of_shaking(TableReader& t, ShakingSpec& shaking, const Scenario& scenario) {
  std::vector<int> places;
  t.references(
      "stages", places, "stage",
      {.meaning = "Stages that it shakes, each with the same record.", .fallback = "all of kind `shake`"});
  for (const int k : places) {
    const record::Stage& stage = scenario.stages.at(static_cast<std::size_t>(k));
    if (stage.kind != record::StageKind::shake)
      t.fail("stages", fmt::format("'{}', which does not shake", stage.name), "stages of kind \"shake\"");
    shaking.stages.push_back(stage.name);
  }
  if (t.documenting() || !places.empty()) return;
  for (const record::Stage& stage : scenario.stages)
    if (stage.kind == record::StageKind::shake) shaking.stages.push_back(stage.name);
  if (shaking.stages.empty()) t.fail("suite", "a suite where nothing shakes", "a stage of kind \"shake\"");
}

constexpr KeyKind number_list[] = {KeyKind::list};

void read_levels_of_shaking(TableReader& t, ShakingSpec& shaking) {
  const bool by_scale = t.find("scales") != nullptr;
  read_numbers(t, "levels", shaking.levels,
               only(!by_scale || t.documenting(), "no scales",
                    {.meaning = "Intensities that each record is brought to, in m/s², m/s or m.",
                     .required = !by_scale && !t.documenting(),
                     .fallback = "required without scales",
                     .kinds = number_list}));
  read_numbers(
      t, "scales", shaking.scales,
      {.meaning =
           "In the place of levels: factors on the records as the list has them, its `scale` included.",
       .fallback = "none",
       .kinds = number_list});
  t.interval("scale_limits", shaking.scale_limits,
             {.meaning = "Factors beyond these are warned of; those beyond twice these are refused.",
              .fallback = "[0.2, 5]"});
}

void read_one_shaking(TableReader& t, ShakingSpec& shaking, const Scenario& scenario) {
  shaking.path = t.path();
  std::string name;
  if (t.reference("suite", name, "suite", {.meaning = "Whose records.", .required = true}))
    for (std::size_t k = 0; k < scenario.suites.size(); ++k)
      if (scenario.suites[k].name == name) shaking.suite = static_cast<int>(k);
  read_stages_of_shaking(t, shaking, scenario);
  t.string("intensity", shaking.intensity,
           {.meaning = "Of what the levels are: PGA, PGV, PGD, SA(T), AvgSA(T1,T2), IA, CAV; T in s."});
  const auto known = loading::intensity_named(shaking.intensity);
  if (!t.documenting() && (!known || known->power == 0))
    t.fail("intensity", describe(*t.find("intensity")), std::string(loading::intensity_names_text));
  t.string(
      "component", shaking.component,
      {.meaning =
           "Of which direction: rotd50, rotd100, geometric-mean, arithmetic-mean, larger; or section: the "
           "vector in the section, up included, of PGA, PGV and IA."});
  if (!t.documenting() && known) check_component(t, shaking, scenario);
  read_levels_of_shaking(t, shaking);
  const std::size_t records =
      shaking.suite < 0 ? 0 : scenario.suites[static_cast<std::size_t>(shaking.suite)].records.size();
  const auto count = [&](const char* key, std::optional<int>& number, std::size_t most, const Rule& rule) {
    t.integer(key, number, rule);
    if (!t.documenting() && most > 0 && number && static_cast<std::size_t>(*number) > most)
      t.fail(key, fmt::format("the integer {}", *number), fmt::format("at most {}", most));
  };
  count("per_realization", shaking.per_realization, records,
        {.meaning = "Records that each rock mass sees, in rotation.", .at_least = 1.0, .fallback = "2"});
  count("levels_per_record", shaking.levels_per_record,
        std::max(shaking.levels.size(), shaking.scales.size()),
        {.meaning = "Levels at which a rock mass sees a record, in rotation.",
         .at_least = 1.0,
         .fallback = "all"});
  if (!shaking.per_realization && records > 0)
    shaking.per_realization = static_cast<int>(std::min<std::size_t>(2, records));
}

}  // namespace

void read_suites(TableReader& root, Scenario& scenario) {
  root.each_table(
      "suite",
      {.meaning = "A list of records of earthquakes, each of which is a motion ([suites](suites.md))."},
      [&](TableReader& t) {
        SuiteSpec suite;
        SuiteOfMotions common;
        read_suite(t, suite, common);
        if (t.documenting()) return;
        add_motions(suite, common, scenario, root.context().list_names["motion"]);
        scenario.suites.push_back(std::move(suite));
      });
}

void keep_used_records(Scenario& scenario) {
  std::vector<int> place(scenario.motions.size(), -1);
  std::vector<MotionSpec> kept;
  for (std::size_t k = 0; k < scenario.motions.size(); ++k) {
    const bool is_used = std::ranges::any_of(
        scenario.stages, [&](const record::Stage& stage) { return stage.motion == static_cast<int>(k); });
    if (scenario.motions[k].suite >= 0 && !is_used) continue;
    place[k] = static_cast<int>(kept.size());
    kept.push_back(scenario.motions[k]);
  }
  for (record::Stage& stage : scenario.stages)
    if (stage.motion >= 0 && static_cast<std::size_t>(stage.motion) < place.size())
      stage.motion = place[static_cast<std::size_t>(stage.motion)];
  scenario.motions = std::move(kept);
}

void read_shaking(TableReader& t, StudySpec& study, const Scenario& scenario) {
  t.tables(
      "shaking", study.shaking,
      {.meaning =
           "Records of a suite, brought to levels of intensity: an axis of the study ([suites](suites.md))."},
      [&](TableReader& s, ShakingSpec& shaking) { read_one_shaking(s, shaking, scenario); });
}

}  // namespace keyblock::scenario
