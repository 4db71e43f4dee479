#pragma once
#include <filesystem>
#include <string>

#include "study/plan.h"

namespace keyblock::study {

/// DIR/plan.json, but for the text of the scenario, which is DIR/study.toml. Paths are relative to DIR where that is
/// possible.
std::string plan_json(const Plan& plan, const std::filesystem::path& directory);

/// Throws InputError when DIR holds no plan, or one that is damaged or of another format.
Plan read_plan(const std::filesystem::path& directory);

}  // namespace keyblock::study
