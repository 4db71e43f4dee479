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
/// What gravity alone does:
///
///   unshaken               the scale of every stage of kind "shake" that follows the stage `since` is 0; all else, durations too, stays.
///
/// And of the trials of a limit:
///
///   still                  a stage of kind "rest" follows the last one, until all is still, of 30 s at most.
namespace keyblock::study {

inline constexpr const char* still_variant = "still";
inline constexpr const char* unshaken_variant = "unshaken";

/// "" and the variants that mean something: "released" when a settling stage excavates, a dynamic one follows, and none of
/// `compared` is among those left out.
std::vector<std::string> variants_of(const scenario::Scenario& scenario,
                                     const std::vector<std::string>& compared);

/// What variants go by.
struct VariantTerms {
  MarginalCheck check;
  std::string since;  ///< as Plan has it: the stage at whose end measures begin, or empty
};

/// Makes the scenario its variant.
void apply_variant(scenario::Scenario& scenario, const std::string& variant, const VariantTerms& terms);

/// Whether the stage shakes the rock after the end of the stage `since` (empty: at any time).
bool shakes_after(const scenario::Scenario& scenario, const record::Stage& stage, const std::string& since);

/// What tells a variant from others in the key of a run: its name and how far it goes.
std::string variant_identity(const std::string& variant, const VariantTerms& terms);

}  // namespace keyblock::study
