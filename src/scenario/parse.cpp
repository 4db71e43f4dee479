#include "scenario/parse.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "core/atomic_file.h"
#include "core/text.h"
#include "scenario/inputs.h"
#include "scenario/key_path.h"
#include "scenario/mistakes.h"
#include "scenario/override.h"
#include "scenario/sections.h"
#include "scenario/stage_steps.h"

namespace keyblock::scenario {
namespace {

struct Reading {
  Scenario scenario;
  Mistakes mistakes;
};

Reading read_document(const Value& document, const std::filesystem::path& file) {
  ReadContext context;
  context.directory = file.parent_path();
  Reading reading;
  TableReader root(context, &document);
  read_scenario(root, reading.scenario);
  root.finish();
  reading.mistakes = std::move(context.mistakes);
  reading.scenario.unusual = std::move(context.unusual);
  reading.scenario.positions = std::move(context.positions);
  reading.scenario.file = file.string();
  return reading;
}

// Puts one value of [[study.vary]], or several that vary together, into the scenario. False when a key leads nowhere.
bool vary(const std::vector<const Value*>& keys, const std::vector<const Value*>& values, Value& document,
          Mistakes& mistakes) {
  for (std::size_t k = 0; k < keys.size(); ++k) {
    try {
      if (const auto failed = apply_override(make_override(keys[k]->text, *values[k]), document)) {
        mistakes.add(*failed);
        return false;
      }
    } catch (const InputError& error) {
      mistakes.add(error.diagnostics());
      return false;
    }
  }
  return true;
}

// The keys of an axis that are strings: `key`, or `keys`.
std::vector<const Value*> keys_of(const Value& axis) {
  std::vector<const Value*> keys;
  const Value *key = axis.find("key"), *list = axis.find("keys");
  if (list == nullptr) {
    if (key != nullptr && key->is(Value::Type::string)) keys.push_back(key);
    return keys;
  }
  for (const Value& item : list->items) {
    if (item.is(Value::Type::string)) keys.push_back(&item);
  }
  return keys;
}

// An axis of [[study.vary]] as it stands in the document: its keys, and rows of a value for each.
struct Axis {
  std::vector<const Value*> keys;
  std::vector<std::vector<const Value*>> rows;
};

// Values of an item of `values`: one each of several keys, or itself.
std::vector<const Value*> row_of(const Value& item, bool several) {
  if (!several) return {&item};
  std::vector<const Value*> row;
  for (const Value& value : item.items) row.push_back(&value);
  return row;
}

// Those axes, and of them those rows, that can be tried.
std::vector<Axis> axes_of(const Value& document) {
  std::vector<Axis> axes;
  const Value* study = document.find("study");
  const Value* list = study == nullptr ? nullptr : study->find("vary");
  if (list == nullptr || !list->is(Value::Type::array)) return axes;
  for (const Value& table : list->items) {
    const Value* values = table.find("values");
    Axis axis{keys_of(table), {}};
    if (axis.keys.empty() || values == nullptr || !values->is(Value::Type::array)) continue;
    const bool several = table.find("keys") != nullptr;
    for (const Value& item : values->items) {
      std::vector<const Value*> row = row_of(item, several);
      if (row.size() == axis.keys.size()) axis.rows.push_back(std::move(row));
    }
    axes.push_back(std::move(axis));
  }
  return axes;
}

// A value may vary once, however its key is written, and not in [study] itself; values are put in in the order of the axes.
class VariedKeys {
 public:
  VariedKeys(const Value& document, Mistakes& mistakes) : document_(document), mistakes_(mistakes) {}

  void add(const Value& key) {
    const auto path = parse_key_path(key.text);
    if (!path) return;
    if (path->front().key == "study")
      mistakes_.add({key.where, key.text, "a key of [study]", "a key of what is studied", ""});
    std::vector<std::string> place = resolved_path(*path, document_);
    for (const auto& [other, text] : before_) {
      if (other == place) {
        mistakes_.add({key.where, key.text, "a key that varies already", "every key once",
                       text == key.text ? "" : "'" + text + "' is the same value"});
      } else if (other.size() > place.size() && std::equal(place.begin(), place.end(), other.begin())) {
        mistakes_.add({key.where, key.text, "a key that holds '" + text + "', which varies already",
                       "it before that one, whose values it replaces", ""});
      }
    }
    before_.emplace_back(std::move(place), key.text);
  }

 private:
  const Value& document_;
  Mistakes& mistakes_;
  std::vector<std::pair<std::vector<std::string>, std::string>> before_;
};

void remove_study(Value& document) {
  std::erase_if(document.items, [](const Value& member) { return member.key == "study"; });
}

// Tries every value of [[study.vary]] alone.
void check_study(const Value& document, const std::filesystem::path& file, Mistakes& mistakes) {
  if (document.find("study") == nullptr) return;
  Value without_study = document;
  remove_study(without_study);
  VariedKeys varied_keys(without_study, mistakes);
  for (const Axis& axis : axes_of(document)) {
    for (const Value* key : axis.keys) varied_keys.add(*key);
    for (const auto& row : axis.rows) {
      if (mistakes.full()) return;
      Value varied = without_study;
      if (!vary(axis.keys, row, varied, mistakes)) break;
      mistakes.add(read_document(varied, file).mistakes);
    }
  }
}

bool concerns(const Diagnostic& diagnostic, const std::string& path) {
  const std::string_view key = diagnostic.key;
  return key.starts_with(path) &&
         (key.size() == path.size() || key[path.size()] == '.' || key[path.size()] == '[');
}

// A scenario that is wrong is refused anyway; mistakes in the files of those motions and trace maps that are right are
// then said at once, too.
void add_mistakes_of_files(const Scenario& scenario, Mistakes& mistakes) {
  Scenario sound;
  sound.file = scenario.file;
  sound.positions = scenario.positions;
  sound.section_azimuth = scenario.section_azimuth.value_or(0.0);
  const std::vector<Diagnostic>& before = mistakes.kept();
  const auto is_sound = [&](const auto& spec) {
    return std::none_of(before.begin(), before.end(),
                        [&](const Diagnostic& diagnostic) { return concerns(diagnostic, spec.path); });
  };
  std::copy_if(scenario.motions.begin(), scenario.motions.end(), std::back_inserter(sound.motions), is_sound);
  std::copy_if(scenario.trace_maps.begin(), scenario.trace_maps.end(), std::back_inserter(sound.trace_maps),
               is_sound);
  try {
    check_inputs(sound);
  } catch (const InputError& error) {
    mistakes.add(error.diagnostics());
  }
}

// What a run refuses before it cuts any block, beside what reading finds. What the files say is looked at once for all
// scenarios that name the same.
class RunCheck {
 public:
  std::vector<Diagnostic> mistakes(const Scenario& scenario, const Value& document) {
    std::string text;
    for (const char* section : {"section", "motion", "trace_map"}) {
      const Value* value = document.find(section);
      text += (value == nullptr ? "" : to_toml(*value)) + "\n";
    }
    const auto [place, added] = known_.try_emplace(text);
    Files& files = place->second;
    if (added) files = read(scenario);
    if (!files.mistakes.empty()) return files.mistakes;
    return stage_mistakes(scenario, files.motions);
  }

 private:
  struct Files {
    std::vector<loading::GroundMotion> motions;
    std::vector<Diagnostic> mistakes;
  };

  static Files read(const Scenario& scenario) {
    Files files;
    try {
      check_inputs(scenario);
      std::vector<std::string> warnings;
      files.motions = read_motions(scenario, warnings);
    } catch (const InputError& error) {
      files.mistakes = error.diagnostics();
    }
    return files;
  }

  std::map<std::string, Files> known_;
};

// Which combination it is, for a mistake that may stand at a value it does not have.
std::string combination_text(const std::vector<Axis>& axes, const std::vector<std::size_t>& places) {
  std::string text;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (std::size_t k = 0; k < axes[a].keys.size(); ++k)
      text += (text.empty() ? "with " : ", ") + axes[a].keys[k]->text + " = " +
              to_toml(*axes[a].rows[places[a]][k]);
  }
  return text;
}

// Adds the mistakes of a combination that no other has, each with the first that has it.
void add_mistakes(const Mistakes& mistakes, const std::string& combination, Mistakes& all) {
  for (Diagnostic mistake : mistakes.kept()) {
    if (!combination.empty()) mistake.hint += (mistake.hint.empty() ? "" : "; ") + combination;
    all.add(std::move(mistake));
  }
}

// The next combination, the last axis changing fastest; false after the last one.
bool advance(const std::vector<Axis>& axes, std::vector<std::size_t>& places) {
  for (std::size_t a = axes.size(); a-- > 0;) {
    if (++places[a] < axes[a].rows.size()) return true;
    places[a] = 0;
  }
  return false;
}

void sort_keys(Value& value) {
  if (value.is(Value::Type::table)) {
    std::stable_sort(value.items.begin(), value.items.end(),
                     [](const Value& a, const Value& b) { return a.key < b.key; });
  }
  for (Value& item : value.items) sort_keys(item);
}

// The document with its overrides; what is wrong with these is added to `mistakes`.
Value overridden(std::string_view text, const std::filesystem::path& file,
                 const std::vector<std::string>& overrides, Mistakes& mistakes) {
  Value document = parse_toml(text, file.string());
  for (const std::string& override_ : overrides) {
    try {
      if (const auto failed = apply_override(parse_override(override_), document)) mistakes.add(*failed);
    } catch (const InputError& error) {
      mistakes.add(error.diagnostics());
    }
  }
  return document;
}

}  // namespace

std::string with_overrides(std::string text, const std::vector<std::string>& overrides) {
  if (!text.empty() && text.back() != '\n') text += '\n';
  for (const std::string& override_ : overrides)
    text += "# --set " + printable(override_, std::string::npos) + "\n";
  return text;
}

namespace {

/// `mistakes` were found before.
Scenario read_checked(const Value& document, const std::filesystem::path& file, Mistakes mistakes) {
  Reading reading = read_document(document, file);
  mistakes.add(reading.mistakes);
  check_study(document, file, mistakes);
  if (!mistakes.empty()) {
    add_mistakes_of_files(reading.scenario, mistakes);
    mistakes.sort(file.string());
    throw mistakes.error();
  }
  return std::move(reading.scenario);
}

}  // namespace

Scenario parse_scenario_text(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides, StudyTable study) {
  Mistakes mistakes;
  Value document = overridden(text, file, overrides, mistakes);
  if (study == StudyTable::leave_out) remove_study(document);
  Scenario scenario = read_checked(document, file, std::move(mistakes));
  scenario.text = with_overrides(std::string(text), overrides);
  return scenario;
}

Scenario parse_document(const Value& document, const std::filesystem::path& file, std::string text) {
  Scenario scenario = read_checked(document, file, {});
  scenario.text = with_overrides(std::move(text), {});
  return scenario;
}

void read_combinations(std::string_view text, const std::filesystem::path& file,
                       const std::vector<std::string>& overrides,
                       const std::function<void(const Scenario&)>& each) {
  Mistakes all;
  const Value document = overridden(text, file, overrides, all);
  if (!all.empty()) throw all.error();
  Value without_study = document;
  remove_study(without_study);
  const std::vector<Axis> axes = axes_of(document);
  std::vector<std::size_t> places(axes.size());
  RunCheck check;
  do {
    Value varied = without_study;
    Mistakes mistakes;
    for (std::size_t a = 0; a < axes.size(); ++a)
      vary(axes[a].keys, axes[a].rows.at(places[a]), varied, mistakes);
    const Reading reading = read_document(varied, file);
    mistakes.add(reading.mistakes);
    if (mistakes.empty()) mistakes.add(check.mistakes(reading.scenario, varied));
    if (mistakes.empty()) each(reading.scenario);
    add_mistakes(mistakes, combination_text(axes, places), all);
  } while (!all.full() && advance(axes, places));
  if (all.empty()) return;
  all.sort(file.string());
  throw all.error();
}

Value document_without_study(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides) {
  Mistakes mistakes;
  Value document = overridden(text, file, overrides, mistakes);
  if (!mistakes.empty()) throw mistakes.error();
  remove_study(document);
  sort_keys(document);
  return document;
}

Scenario parse_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scenario_text(read_file(file, largest_scenario), file, overrides);
}

Box box_of_model(const Scenario& scenario) {
  Box box;
  if (scenario.domain) box.add(scenario.domain->box());
  for (const BlockSpec& block : scenario.blocks) box.add(bounds(block.polygon));
  return box;
}

SourcePosition Scenario::where(const std::string& key_path) const {
  const SourcePosition position = nearest_position(positions, key_path);
  return position.file.empty() ? SourcePosition{file, 1, 1} : position;
}

}  // namespace keyblock::scenario
