#pragma once
#include <filesystem>
#include <string>

#include "study/plan.h"

namespace keyblock::study {

/// DIR/plan.json: the plan except for the text of the scenario, which is DIR/study.toml. The scenario is named from DIR and by its
/// full path.
std::string plan_json(const Plan& plan, const std::filesystem::path& directory);

/// Throws InputError when DIR holds no plan, or one that is damaged or of another format, and when DIR/study.toml is another
/// scenario than the plan was made of (except for [study]).
Plan read_plan(const std::filesystem::path& directory);

}  // namespace keyblock::study
