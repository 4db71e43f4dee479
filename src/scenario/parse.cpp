#include "scenario/parse.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include "core/atomic_file.h"
#include "scenario/inputs.h"
#include "scenario/key_path.h"
#include "scenario/override.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

struct Reading {
  Scenario scenario;
  std::vector<Diagnostic> diagnostics;
};

// The section to which a key, or one that is written much like it, belongs.
std::string find_elsewhere(const std::string& key) {
  std::vector<std::string> keys;
  std::map<std::string, std::string> section_of;
  for (const SectionReference& section : key_reference()) {
    for (const KeyReference& known : section.keys) {
      if (section.title.starts_with('[') && section_of.emplace(known.key, section.title).second) {
        keys.push_back(known.key);
      }
    }
  }
  const std::string best = closest_word(key, keys);
  return best.empty() ? "" : "'" + best + "' belongs to " + section_of[best];
}

Reading read_document(const Value& document, const std::filesystem::path& file) {
  ReadContext context;
  context.directory = file.parent_path();
  context.find_elsewhere = find_elsewhere;
  Reading reading;
  TableReader root(context, &document);
  read_scenario(root, reading.scenario);
  root.finish();
  reading.diagnostics = std::move(context.diagnostics);
  reading.scenario.positions = std::move(context.positions);
  reading.scenario.file = file.string();
  return reading;
}

bool same(const Diagnostic& a, const Diagnostic& b) {
  return a.to_string() == b.to_string();
}

// Adds what is not there yet.
void merge(std::vector<Diagnostic>& all, std::vector<Diagnostic> more) {
  for (Diagnostic& diagnostic : more) {
    const bool known =
        std::any_of(all.begin(), all.end(), [&](const Diagnostic& d) { return same(d, diagnostic); });
    if (!known) all.push_back(std::move(diagnostic));
  }
}

// What one value of [[study.vary]] would do to the scenario. Returns false when its key leads nowhere, for which the
// other values need not be tried.
bool try_value(const std::string& key, const Value& value, const Value& document,
               const std::filesystem::path& file, std::vector<Diagnostic>& diagnostics) {
  Value varied = document;
  try {
    if (const auto failed = apply_override(make_override(key, value), varied)) {
      merge(diagnostics, {*failed});
      return false;
    }
  } catch (const InputError& error) {
    merge(diagnostics, error.diagnostics());
    return false;
  }
  merge(diagnostics, read_document(varied, file).diagnostics);
  return true;
}

// Tries every value of [[study.vary]] alone.
void check_study(const Value& document, const std::filesystem::path& file,
                 std::vector<Diagnostic>& diagnostics) {
  const Value* study = document.find("study");
  const Value* vary = study == nullptr ? nullptr : study->find("vary");
  if (vary == nullptr || !vary->is(Value::Type::array)) return;
  Value without_study = document;
  std::erase_if(without_study.items, [](const Value& member) { return member.key == "study"; });
  for (const Value& axis : vary->items) {
    const Value *key = axis.find("key"), *values = axis.find("values");
    if (key == nullptr || values == nullptr || !key->is(Value::Type::string)) continue;
    for (const Value& value : values->items) {
      if (!try_value(key->text, value, without_study, file, diagnostics)) break;
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
void add_mistakes_of_files(const Scenario& scenario, std::vector<Diagnostic>& diagnostics) {
  Scenario sound;
  sound.file = scenario.file;
  sound.positions = scenario.positions;
  sound.section_azimuth = scenario.section_azimuth.value_or(0.0);
  const auto is_sound = [&](const auto& spec) {
    return std::none_of(diagnostics.begin(), diagnostics.end(),
                        [&](const Diagnostic& diagnostic) { return concerns(diagnostic, spec.path); });
  };
  std::copy_if(scenario.motions.begin(), scenario.motions.end(), std::back_inserter(sound.motions), is_sound);
  std::copy_if(scenario.trace_maps.begin(), scenario.trace_maps.end(), std::back_inserter(sound.trace_maps),
               is_sound);
  try {
    check_inputs(sound);
  } catch (const InputError& error) {
    merge(diagnostics, error.diagnostics());
  }
}

// Mistakes in the scenario in the order of the file, then overrides.
void sort_by_position(std::vector<Diagnostic>& diagnostics, const std::string& file) {
  const auto rank = [&](const Diagnostic& d) {
    const int place = d.where.file == file ? 0 : d.where.line == 0 ? 1 : 2;
    return place == 0 ? std::tuple(place, d.where.line, d.where.column) : std::tuple(place, 0, 0);
  };
  std::stable_sort(diagnostics.begin(), diagnostics.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return rank(a) < rank(b); });
}

}  // namespace

Scenario parse_scenario_text(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides) {
  Value document = parse_toml(text, file.string());
  std::vector<Diagnostic> diagnostics;
  for (const std::string& override_ : overrides) {
    try {
      if (const auto failed = apply_override(parse_override(override_), document))
        diagnostics.push_back(*failed);
    } catch (const InputError& error) {
      merge(diagnostics, error.diagnostics());
    }
  }
  Reading reading = read_document(document, file);
  merge(diagnostics, std::move(reading.diagnostics));
  check_study(document, file, diagnostics);
  if (!diagnostics.empty()) {
    add_mistakes_of_files(reading.scenario, diagnostics);
    sort_by_position(diagnostics, file.string());
    throw InputError(std::move(diagnostics));
  }
  Scenario scenario = std::move(reading.scenario);
  scenario.text = text;
  if (!scenario.text.empty() && scenario.text.back() != '\n') scenario.text += '\n';
  for (const std::string& override_ : overrides) scenario.text += "# --set " + override_ + "\n";
  return scenario;
}

Scenario parse_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scenario_text(read_file(file), file, overrides);
}

SourcePosition Scenario::where(const std::string& key_path) const {
  SourcePosition position = nearest_position(positions, key_path);
  if (position.file.empty()) position.file = file;
  return position;
}

}  // namespace keyblock::scenario
