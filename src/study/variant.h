#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "study/run_result.h"

/// Variants of a run, by which it is told whether its result is marginal:
///
///   friction-, friction+   the friction angle of every joint lowered or raised by MarginalCheck::friction: that of
///                          [joints] and of every set and map that has one of its own; within 0 … 89.9°. The frame keeps its own.
///   released               what was excavated in stages of kind "settle" is taken out at the start of the dynamic stage that
///                          follows, and the settling stages from the first excavation up to it are left out: the rock is
///                          released at once.
///
/// And of the trials of a limit:
///
///   still                  a stage of kind "rest" follows the last one, until all is still, of 30 s at most.
namespace keyblock::study {

inline constexpr const char* still_variant = "still";

/// "" and the variants that mean something: "released" when a settling stage excavates, a dynamic one follows, and none of
/// `compared` is among those left out.
std::vector<std::string> variants_of(const scenario::Scenario& scenario,
                                     const std::vector<std::string>& compared);

/// Makes the scenario its variant.
void apply_variant(scenario::Scenario& scenario, const std::string& variant, const MarginalCheck& check);

/// What tells a variant from others in the key of a run: its name and how far it goes.
std::string variant_identity(const std::string& variant, const MarginalCheck& check);

}  // namespace keyblock::study
