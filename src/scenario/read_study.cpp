#include <algorithm>
#include <string>

#include "record/damage_fields.h"
#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr Word<Keep> keep_words[] = {
    {"all", Keep::all}, {"report", Keep::report}, {"measures", Keep::measures}};

constexpr Word<bool> samplings[] = {{"independent", false}, {"latin_hypercube", true}};

constexpr KeyKind key_list[] = {KeyKind::references}, value_list[] = {KeyKind::list};

// `key`, or `keys` that vary together.
void read_keys(TableReader& t, VarySpec& vary) {
  std::string key;
  const bool several = t.find("keys") != nullptr;
  Rule rule{.meaning = "Key path of the value that varies, as for `--set`: `stage.'first earthquake'.scale`.",
            .required = !several && !t.documenting(),
            .fallback = "`keys`",
            .applies = !several};
  rule.condition = several ? "`keys` left out" : "";
  if (t.string("key", key, rule)) vary.keys = {key};
  const Value* keys =
      t.any("keys", "array of strings",
            {.meaning = "In the place of `key`: several that vary together, as `keys = [\"a\", \"b\"]` with "
                        "`values = [[1, 2], [3, 4]]`.",
             .kinds = key_list});
  if (keys == nullptr) return;
  const auto is_string = [](const Value& item) { return item.is(Value::Type::string); };
  if (!keys->is(Value::Type::array) || keys->items.empty() ||
      !std::all_of(keys->items.begin(), keys->items.end(), is_string)) {
    t.fail("keys", describe(*keys), "an array of key paths");
    return;
  }
  for (const Value& item : keys->items) vary.keys.push_back(item.text);
}

void read_rotation(TableReader& t, VarySpec& vary, std::size_t values) {
  t.integer(
      "per_realization", vary.per_realization,
      {.meaning =
           "How many of the values each realization takes, in rotation: with records as values, each rock "
           "mass sees some of them, and each record many rock masses.",
       .at_least = 1.0,
       .fallback = "all"});
  if (!t.documenting() && vary.per_realization && static_cast<std::size_t>(*vary.per_realization) > values)
    t.fail("per_realization", "the integer " + std::to_string(*vary.per_realization),
           "at most the " + std::to_string(values) + " of `values`");
}

void read_vary(TableReader& t, VarySpec& vary) {
  read_keys(t, vary);
  const Value* values =
      t.any("values", "array", {.meaning = "The values it takes.", .required = true, .kinds = value_list});
  if (t.documenting()) read_rotation(t, vary, 0);
  if (values == nullptr) return;
  if (!values->is(Value::Type::array) || values->items.empty()) {
    t.fail("values", describe(*values), "an array of values");
    return;
  }
  read_rotation(t, vary, values->items.size());
  const bool several = t.find("keys") != nullptr;
  std::vector<const Value*> seen;
  for (std::size_t k = 0; k < values->items.size(); ++k) {
    const Value& item = values->items[k];
    const std::string path = join_index(join_path(t.path(), "values"), k);
    std::vector<std::string> texts;
    if (!several) {
      texts = {to_toml(item)};
    } else if (!item.is(Value::Type::array) || item.items.size() != vary.keys.size()) {
      if (!vary.keys.empty()) {
        t.fail_at(item, path, describe(item),
                  "an array of " + std::to_string(vary.keys.size()) + " values, one for each of `keys`");
      }
      continue;
    } else {
      for (const Value& value : item.items) texts.push_back(to_toml(value));
    }
    if (std::any_of(seen.begin(), seen.end(), [&](const Value* other) { return same_value(*other, item); })) {
      t.fail_at(item, path, describe(item) + " again", "every value once");
      continue;
    }
    seen.push_back(&item);
    vary.values.push_back(std::move(texts));
  }
}

void read_measure(TableReader& t, std::string& measure, std::string_view meaning) {
  if (!t.string("measure", measure, {.meaning = meaning, .required = true})) return;
  const std::vector<std::string> names = record::damage_names();
  if (std::find(names.begin(), names.end(), measure) != names.end()) return;
  t.fail("measure", describe(*t.find("measure")), list_words(names), suggestion(measure, names));
}

void read_until(TableReader& t, UntilSpec& until) {
  read_measure(t, until.measure, "Measure of damage, by its name in summary.json.");
  t.number("half_width", until.half_width,
           {.meaning = "Narrow enough: half the width of the interval is at most this share of the mean. "
                       "Where `width` is given as well, one of both is enough. Not reached while all values "
                       "are equal.",
            .above = 0.0});
  t.number(
      "width", until.width,
      {.meaning = "Narrow enough: the width of the interval, in the unit of the measure, is at most this.",
       .above = 0.0});
  if (t.find("half_width") == nullptr && t.find("width") == nullptr) {
    t.missing("half_width", "`half_width` or `width`");
  }
  t.integer("minimum", until.minimum, {.meaning = "Realizations that are run in any case.", .at_least = 2.0});
  t.integer("maximum", until.maximum,
            {.meaning = "Realizations after which the study ends in any case.", .at_least = 2.0});
  if (until.maximum < until.minimum) {
    t.fail("maximum", "the integer " + std::to_string(until.maximum),
           "at least the `minimum` of " + std::to_string(until.minimum));
  }
}

void read_levels(TableReader& t, StudySpec& study) {
  t.tables(
      "level", study.levels,
      {.meaning = "A level of damage whose probability is estimated: a measure above a threshold. Without "
                  "any: light, moderate and severe, 0.2, 2 and 10 % of the area of the openings fallen."},
      [&](TableReader& l, LevelSpec& level) {
        l.string("name", level.name, {.meaning = "Name in the report.", .required = true});
        const bool again = std::any_of(study.levels.begin(), study.levels.end(),
                                       [&](const LevelSpec& other) { return other.name == level.name; });
        if (again && !level.name.empty()) {
          l.fail("name", describe(*l.find("name")) + " again", "a name that no other level has");
        }
        read_measure(l, level.measure, "Measure of damage, by its name in summary.json.");
        l.number("threshold", level.threshold,
                 {.meaning = "The level is reached above it.",
                  .unit = "of the measure",
                  .required = true,
                  .at_least = 0.0});
      });
}

void read_marginal(TableReader& t, StudySpec& study) {
  t.table("marginal",
          {.meaning = "Runs every case again with friction lowered, with friction raised, and with an "
                      "immediate release, and calls it marginal when its fallen area changes much."},
          [&](TableReader& m) {
            MarginalSpec& marginal = study.marginal.emplace();
            m.number("friction", marginal.friction,
                     {.meaning = "By how much the friction angle of all joints is lowered and raised.",
                      .unit = "°",
                      .above = 0.0,
                      .below = 90.0});
            m.number(
                "share", marginal.share,
                {.meaning = "Marginal: the fallen area changes by more than this share of the larger one.",
                 .above = 0.0,
                 .at_most = 1.0});
          });
}

void read_control(TableReader& t, StudySpec& study) {
  const bool has_suite = !study.shaking.empty();
  study.control = has_suite && study.since != from_the_start;
  t.boolean(
      "control", study.control,
      {.meaning = "Runs each rock mass once more without the shaking that comes after `since`. What comes "
                  "down in that run, gravity brought "
                  "down, and it is taken off what counts as brought down by the shaking. True by default "
                  "with [[study.shaking]]."});
  if (study.control && study.since == from_the_start)
    t.fail("control", "true with since = \"start\", which counts all that gravity brought down",
           "one of the two");
}

void read_keys_of_study(TableReader& t, StudySpec& study, const Scenario& scenario) {
  const bool until = t.find("until") != nullptr;
  Rule rule{.meaning = "Number of realizations of the joint sets.", .at_least = 1.0, .applies = !until};
  rule.condition = until ? "`until` left out" : "";
  t.integer("realizations", study.realizations, rule);
  Rule sampling{.meaning =
                    "How strengths with `per = \"realization\"` are drawn: `latin_hypercube`, one "
                    "realization in each part of "
                    "equal probability, of as many parts as there are realizations; or each by itself.",
                .applies = !until};
  sampling.condition =
      until ? "`until` left out, as it needs a number of realizations that is known before" : "";
  t.word("sampling", study.latin_hypercube, samplings, sampling);
  t.tables("vary", study.vary, {.meaning = "One axis of the grid; all combinations are run."},
           [](TableReader& v, VarySpec& vary) { read_vary(v, vary); });
  read_shaking(t, study, scenario);
  t.reference("stage", study.stage, "stage",
              {.meaning = "At whose end the measures are compared.", .fallback = "the last stage"});
  t.reference("since", study.since, "stage",
              {.meaning = "An earlier one, at whose end the measures begin: what comes down before it is "
                          "taken off. \"start\": "
                          "nothing is taken off; measures begin at the first excavation. The default counts "
                          "what the shaking "
                          "adds to what gravity brought down; where nothing shakes, or no stage is before "
                          "the shaking, it is "
                          "\"start\".",
               .fallback = "the last stage before the first shaking of the opening"},
              from_the_start);
  t.number("confidence", study.confidence,
           {.meaning = "Confidence level of all intervals.", .above = 0.0, .below = 1.0});
  t.table("until",
          {.meaning = "In the place of `realizations`: they are added until the confidence interval of the "
                      "mean of a measure is narrow enough for every combination."},
          [&](TableReader& u) { read_until(u, study.until.emplace()); });
  read_levels(t, study);
  read_marginal(t, study);
  read_control(t, study);
  t.table("map", {.meaning = "The raster on which is counted how often rock falls."}, [&](TableReader& m) {
    m.number("cell", study.map_cell,
             {.meaning = "Width of a cell.",
              .unit = "m",
              .above = 0.0,
              .fallback = "1/40 of the width of the opening"});
  });
  t.word("keep", study.keep, keep_words,
         {.meaning = "What stays of every run beside its measures and its picture: `all`: result file and "
                     "report; `report`: the report; `measures`: nothing."});
}

}  // namespace

std::string VarySpec::key_text() const {
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : " + ") + key;
  return text;
}

std::string VarySpec::value_text(std::size_t k) const {
  std::string text;
  for (const std::string& value : values.at(k)) text += (text.empty() ? "" : ", ") + value;
  return text;
}

void read_study(TableReader& root, Scenario& scenario) {
  root.table("study",
             {.meaning = "A Monte Carlo study for `keyblock study`: realizations × a grid of values "
                         "([guide](studies.md))."},
             [&](TableReader& t) { read_keys_of_study(t, scenario.study.emplace(), scenario); });
  if (scenario.study && scenario.study->latin_hypercube) scenario.strata = scenario.study->realizations;
}

}  // namespace keyblock::scenario
