#pragma once
#include <filesystem>
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

/// The document with its overrides and without [study], the keys of every table in alphabetical order: what every run of a
/// study starts from. Throws InputError.
Value document_without_study(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides);

}  // namespace keyblock::scenario
