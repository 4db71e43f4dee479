#include "study/fragility_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyblock::study {

namespace {

using statistics::FragilityStatus;
using statistics::Stripe;

std::string number(double x) {
  return std::isinf(x) ? "∞" : fmt::format("{:.3g}", x);
}

std::string with_unit(double x, const std::string& unit) {
  return number(x) + (unit.empty() ? "" : " " + unit);
}

std::string counts(const Stripe& s, const std::string& unit) {
  return fmt::format("{:.0f} of {:.0f} runs at {}", s.exceeded, s.runs, with_unit(s.intensity, unit));
}

/// Stripes none of which lies between a share of 0 below and one of 1 above, but one at most.
std::string why_separated(const std::vector<Stripe>& stripes, const std::string& unit) {
  const auto none = [](const Stripe& s) { return s.exceeded == 0.0; };
  const auto all = [](const Stripe& s) { return s.exceeded == s.runs; };
  if (std::all_of(stripes.begin(), stripes.end() - 1, none))
    return fmt::format("the level is exceeded at the strongest shaking only ({})",
                       counts(stripes.back(), unit));
  if (std::all_of(stripes.begin() + 1, stripes.end(), all))
    return fmt::format("every run exceeds the level, except at the weakest shaking ({})",
                       counts(stripes.front(), unit));
  const auto last_none = std::find_if_not(stripes.begin(), stripes.end(), none) - 1;
  const auto first_all = std::find_if(stripes.begin(), stripes.end(), all);
  return fmt::format("no run exceeds the level up to {}, and every run does from {} on",
                     with_unit(last_none->intensity, unit), with_unit(first_all->intensity, unit));
}

std::string why_wide(const char* what, const statistics::Estimate& e, const std::string& unit, double factor,
                     double confidence) {
  return fmt::format("the {:.3g} % interval of {} spans {} … {}, more than a factor of {}",
                     100.0 * confidence, what, number(e.low), with_unit(e.high, unit), factor);
}

std::string why_few_fits(const statistics::FragilityCurve& curve) {
  const auto has_none = [](const statistics::FragilityFit& fit) {
    return fit.status != FragilityStatus::fitted;
  };
  const auto count = [&](const std::vector<statistics::FragilityFit>& fits) {
    return std::ranges::count_if(fits, has_none);
  };
  const auto rocks = count(curve.refits.rocks), records = count(curve.refits.records);
  const std::string of = rocks == 0 ? fmt::format("{} of {} records", records, curve.refits.records.size())
                                    : fmt::format("{} of {} realizations", rocks, curve.refits.rocks.size());
  return fmt::format("it hangs on single ones: {} cannot be left out", of);
}

}  // namespace

std::string for_which_records(const statistics::FragilityCurve& curve) {
  if (curve.records == 1) return "for this record only";
  if (curve.records < statistics::few_records)
    return fmt::format("over {} records, which are few: the intervals are wide for that reason",
                       curve.records);
  return fmt::format("over {} records", curve.records);
}

std::string why_no_curve(const StudyData& study, const FragilityGroup& group) {
  const statistics::FragilityCurve& curve = group.curve;
  const Intensity& intensity = intensities()[group.intensity];
  const statistics::FragilityLimits limits = fragility_limits(intensity);
  switch (curve.status) {
    case FragilityStatus::fitted:
      return "";
    case FragilityStatus::no_data:
      return "no run was shaken";
    case FragilityStatus::one_intensity:
      return "all runs are at the same intensity";
    case FragilityStatus::never_exceeded:
      return "no run exceeds the level";
    case FragilityStatus::always_exceeded:
      return "every run exceeds the level";
    case FragilityStatus::separated:
      return why_separated(curve.stripes, intensity.unit);
    case FragilityStatus::not_increasing:
      return "more shaking does not go with more damage";
    case FragilityStatus::exceeded_at_rest:
      return fmt::format(
          "the level is exceeded without shaking in {:.0f} of {:.0f} cases, where a lognormal curve is zero",
          curve.at_rest.exceeded, curve.at_rest.runs);
    case FragilityStatus::too_few_clusters:
      return fmt::format("{} realizations are too few for an interval of the median; {} give one",
                         curve.clusters, statistics::smallest_bootstrap_sample);
    case FragilityStatus::few_fits:
      return why_few_fits(curve);
    case FragilityStatus::wide_theta:
      return why_wide("the median θ", curve.theta, intensity.unit, limits.widest_theta, study.confidence);
    case FragilityStatus::wide_beta:
      return why_wide("β", curve.beta, "", limits.widest_beta, study.confidence);
  }
  return "";
}

}  // namespace keyblock::study
