#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/value.h"

namespace keyblock::scenario {

/// Reads and checks a scenario file. `overrides` are `key=value`, applied in order before the file is checked; a
/// later one wins. Files the scenario names must exist; they are read only to report their mistakes beside others.
///
/// Throws one InputError with every mistake found, in the order of the file. A mistake in an overridden value has
/// `--set key=value` in the place of the file. The values of [[study.vary]] are checked, each alone, as if they were
/// overrides.
Scenario parse_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

enum class StudyTable {
  check,     ///< [study] is read, and all its values are tried
  leave_out  ///< it is passed over: for one run of a study that has been checked
};

/// The same from text; `file` is the name in messages, and its folder that to which paths are relative.
Scenario parse_scenario_text(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides = {},
                             StudyTable study = StudyTable::check);

/// The same of a document at hand. `text` is what results keep of it.
Scenario parse_document(const Value& document, const std::filesystem::path& file, std::string text);

/// The text of a scenario with its overrides as comments at its end.
std::string with_overrides(std::string text, const std::vector<std::string>& overrides);

/// Every combination of the values of [[study.vary]], the last axis changing fastest, as its run reads it: `each` is called for
/// those that are right. Without axes that is the scenario itself. The study must have been read before.
///
/// Throws one InputError with all that a run would refuse before it cuts any block: mistakes of values together, in the files
/// they name, stages of less than one step. A mistake in a value stands at its place in [study], and every mistake names the
/// first combination that has it.
void read_combinations(std::string_view text, const std::filesystem::path& file,
                       const std::vector<std::string>& overrides,
                       const std::function<void(const Scenario&)>& each);

/// The document with its overrides and without [study], the keys of every table in alphabetical order: what every run of a
/// study starts from. Throws InputError.
Value document_without_study(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides);

}  // namespace keyblock::scenario
