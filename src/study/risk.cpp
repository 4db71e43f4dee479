#include "study/risk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "study/expected.h"
#include "study/fragility_words.h"

namespace keyblock::study {
namespace {

using statistics::Estimate;
using statistics::FragilityFit;
using statistics::FragilityStatus;
using statistics::HazardCurve;
using statistics::Lognormal;
using statistics::Stripe;

constexpr double largest_share_of_ends = 0.05;
constexpr double largest_share_below_runs = 0.30;

std::size_t intensity_of(const StudyData& study, const std::vector<Hazard>& hazards) {
  const Hazard& first = hazards.front();
  std::string known, same_name;
  for (const std::size_t k : known_intensities(study)) {
    const Intensity& own = intensities()[k];
    if (own.kind == first.found.intensity && own.component == first.source.component) return k;
    known += fmt::format("{}{} of {}", known.empty() ? "" : ", ", own.kind, own.component);
    if (own.kind == first.found.intensity) same_name = own.component;
  }
  Diagnostic diagnostic;
  diagnostic.where.file = first.source.file.string();
  diagnostic.found =
      fmt::format("a hazard of {}, component {}", first.found.intensity, first.source.component);
  diagnostic.expected = "one of those that the study has: " + known;
  if (!same_name.empty())
    diagnostic.hint = fmt::format(
        "where the curve is of another component, say so by `component = \"{}\"` in [[hazard]]", same_name);
  throw InputError(std::move(diagnostic));
}

/// The hazard curves with their weights.
class Mean {
 public:
  explicit Mean(const std::vector<Hazard>& hazards) : hazards_(hazards) {
    for (const Hazard& hazard : hazards) sum_ += hazard.source.weight;
  }

  template <class Of>
  [[nodiscard]] double of(const Of& each) const {
    double mean = 0.0;
    for (const Hazard& hazard : hazards_) mean += hazard.source.weight / sum_ * each(hazard.found.curve);
    return mean;
  }
  [[nodiscard]] double first() const {
    double x = HUGE_VAL;
    for (const Hazard& hazard : hazards_) x = std::min(x, hazard.found.curve.first());
    return x;
  }
  [[nodiscard]] double last() const {
    double x = 0.0;
    for (const Hazard& hazard : hazards_) x = std::max(x, hazard.found.curve.last());
    return x;
  }

 private:
  const std::vector<Hazard>& hazards_;
  double sum_ = 0.0;
};

/// What one level and group has.
class LevelFinder {
 public:
  LevelFinder(const StudyData& study, const Risk& risk, const FragilityGroup& group)
      : study_(study), risk_(risk), group_(group), curve_(group.curve), hazard_(risk.hazards) {}

  LevelRisk find() {
    found_.why = why_no_curve(study_, group_);
    switch (curve_.status) {
      case FragilityStatus::fitted:
        find_rate();
        break;
      case FragilityStatus::separated:
        find_step();
        break;
      case FragilityStatus::never_exceeded:
        find_upper_limit();
        break;
      default:
        break;
    }
    return found_;
  }

 private:
  [[nodiscard]] double total(const Lognormal& fragility) const {
    return hazard_.of([&](const HazardCurve& h) { return statistics::annual_rate(h, fragility).total(); });
  }

  void find_rate() {
    const Lognormal fragility{curve_.fit.theta, curve_.fit.beta};
    const auto log_rate = [&](const FragilityFit& fit) {
      return fit.status == FragilityStatus::fitted ? std::log(total({fit.theta, fit.beta}))
                                                   : statistics::not_a_number;
    };
    const Estimate e =
        statistics::two_way_interval(log_rate(curve_.fit), curve_.refits.numbers(log_rate), risk_.confidence);
    found_.rate = {std::exp(e.value), std::exp(e.low), std::exp(e.high)};
    for (const Hazard& hazard : risk_.hazards)
      found_.by_hazard.push_back(statistics::annual_rate(hazard.found.curve, fragility).total());
    find_shares(fragility);
    find_from_points();
    find_probabilities();
    judge(fragility);
  }

  void find_shares(const Lognormal& fragility) {
    const auto parts = [&](double statistics::Rate::*part) {
      return hazard_.of([&](const HazardCurve& h) { return statistics::annual_rate(h, fragility).*part; });
    };
    const double middle =
        0.5 * (parts(&statistics::Rate::beyond_low) + parts(&statistics::Rate::beyond_high));
    const double inner = found_.rate.value - middle;
    below_hazard_ = parts(&statistics::Rate::below);
    beyond_hazard_ = middle;
    found_.low_end = inner + parts(&statistics::Rate::beyond_low);
    found_.high_end = inner + parts(&statistics::Rate::beyond_high);
    const auto up_to = [&](double x) {
      return hazard_.of([&](const HazardCurve& h) { return statistics::rate_up_to(h, fragility, x); });
    };
    found_.share_below_runs = up_to(curve_.stripes.front().intensity) / found_.rate.value;
    found_.share_above_runs = 1.0 - up_to(curve_.stripes.back().intensity) / found_.rate.value;
    const double low = hazard_.first() * std::exp(-20.0), high = hazard_.last();
    const auto at_share = [&](double share) {
      return statistics::intensity_where(up_to, share * inner, low, high);
    };
    found_.x16 = at_share(0.16);
    found_.x50 = at_share(0.50);
    found_.x84 = at_share(0.84);
  }

  void find_from_points() {
    statistics::KnownPoints points;
    for (const Stripe& s : curve_.stripes) {
      points.intensity.push_back(s.intensity);
      points.value.push_back(s.exceeded / s.runs);
    }
    const auto part = [&](double statistics::PointsRate::*member) {
      return hazard_.of([&](const HazardCurve& h) { return statistics::rate_of_points(h, points).*member; });
    };
    const double between = part(&statistics::PointsRate::between);
    found_.points_low = between + part(&statistics::PointsRate::beyond_low);
    found_.points_high =
        between + hazard_.of([&](const HazardCurve& h) { return h.rate_at(points.intensity.back()); });
  }

  /// σ of rock, record and rest with β² as their sum of squares; none where the split is not known.
  [[nodiscard]] std::optional<statistics::Scatter> scatter() const {
    const statistics::Split& split = curve_.split;
    if (std::isnan(split.rock.value)) return std::nullopt;
    const double all = std::hypot(split.rock.value, split.record.value, split.rest.value);
    const double factor = curve_.fit.beta / all;
    return statistics::Scatter{factor * split.rock.value, factor * split.record.value,
                               factor * split.rest.value};
  }

  void find_probabilities() {
    const double theta = curve_.fit.theta, beta = curve_.fit.beta;
    found_.annual = -std::expm1(-found_.rate.value);
    found_.lifetime_poisson = -std::expm1(-found_.rate.value * risk_.lifetime);
    const auto known = scatter();
    const auto sections = [&](const statistics::Scatter& s) {
      return hazard_.of(
          [&](const HazardCurve& h) { return statistics::rate_of_sections(h, theta, s, risk_.sections); });
    };
    found_.sections_low = found_.sections_high = found_.rate.value;
    if (risk_.sections > 1.0)
      found_.sections_high = sections(known.value_or(statistics::Scatter{beta, 0.0, 0.0}));
    if (!known) return;
    if (risk_.sections > 1.0) found_.sections_low = found_.sections_high;
    const auto life = [&](double statistics::Lifetime::*member) {
      return hazard_.of([&](const HazardCurve& h) {
        return statistics::over_lifetime(h, theta, *known, risk_.lifetime).*member;
      });
    };
    found_.lifetime = life(&statistics::Lifetime::probability);
    found_.p05 = life(&statistics::Lifetime::p05);
    found_.p50 = life(&statistics::Lifetime::p50);
    found_.p95 = life(&statistics::Lifetime::p95);
  }

  void judge(const Lognormal& fragility) {
    const double ends = (below_hazard_ + beyond_hazard_) / found_.rate.value;
    const std::string& unit = intensities()[group_.intensity].unit;
    found_.status = RiskStatus::known;
    if (ends > largest_share_of_ends) {
      found_.status = RiskStatus::hazard_too_short;
      found_.why = fmt::format(
          "{:.0f} % of the rate is from beyond the ends of the hazard curve, which has {:.3g} … {:.3g} {}",
          100.0 * ends, hazard_.first(), hazard_.last(), unit);
    } else if (found_.share_below_runs > largest_share_below_runs) {
      const double k = hazard_.of([&](const HazardCurve& h) { return h.slope_at(fragility.theta); });
      found_.status = RiskStatus::runs_too_strong;
      found_.why = fmt::format(
          "{:.0f} % of the rate is from shaking weaker than that of all runs, where only the form of the "
          "curve tells; "
          "run it at about {:.2g} {}, too",
          100.0 * found_.share_below_runs, fragility.theta * std::exp(-k * fragility.beta * fragility.beta),
          unit);
    }
  }

  [[nodiscard]] double hazard_at(double x) const {
    return hazard_.of([&](const HazardCurve& h) { return h.rate_at(x); });
  }

  /// The level is reached somewhere between the strongest shaking that no run exceeds it at, and the weakest that all do.
  void find_step() {
    found_.status = RiskStatus::step;
    found_.rate.low = 0.0;
    for (const Stripe& s : curve_.stripes) {
      if (s.exceeded == 0.0) found_.rate.high = hazard_at(s.intensity);
      if (s.exceeded < s.runs) continue;
      found_.rate.low = hazard_at(s.intensity);
      break;
    }
  }

  /// P is at most the upper end of the interval at the next stronger shaking that was run, and 1 beyond all.
  void find_upper_limit() {
    found_.status = RiskStatus::upper_limit;
    double from = hazard_at(std::min(hazard_.first(), curve_.stripes.front().intensity)), sum = 0.0;
    for (std::size_t k = 0; k < curve_.stripes.size(); ++k) {
      const double to = hazard_at(curve_.stripes[k].intensity);
      sum += group_.points[k].high * (from - to);
      from = to;
    }
    found_.rate.low = 0.0;
    found_.rate.high = sum + from;
  }

  const StudyData& study_;
  const Risk& risk_;
  const FragilityGroup& group_;
  const statistics::FragilityCurve& curve_;
  Mean hazard_;
  LevelRisk found_;
  double below_hazard_ = 0.0, beyond_hazard_ = 0.0;
};

std::vector<std::string> level_names(const StudyData& study) {
  std::vector<std::string> names;
  for (const DamageLevel& level : study.levels) names.push_back(level.name);
  return names;
}

void check_level(const StudyData& study, const std::string& level) {
  const std::vector<std::string> names = level_names(study);
  if (level.empty() || std::ranges::find(names, level) != names.end()) return;
  Diagnostic diagnostic;
  diagnostic.key = "--level";
  diagnostic.found = '"' + level + '"';
  diagnostic.expected =
      names.empty() ? "a study with levels of damage" : fmt::format("{}", fmt::join(names, ", "));
  throw InputError(std::move(diagnostic));
}

}  // namespace

const char* name_of(RiskStatus status) {
  switch (status) {
    case RiskStatus::known:
      return "known";
    case RiskStatus::hazard_too_short:
      return "hazard_too_short";
    case RiskStatus::runs_too_strong:
      return "runs_too_strong";
    case RiskStatus::step:
      return "step";
    case RiskStatus::upper_limit:
      return "upper_limit";
    case RiskStatus::no_curve:
      return "no_curve";
  }
  return "";
}

Risk find_risk(const StudyData& study, const Summary& summary, const RiskSettings& settings,
               const std::string& level) {
  check_level(study, level);
  Risk risk;
  risk.hazards = read_hazards(settings);
  risk.intensity = intensity_of(study, risk.hazards);
  risk.lifetime = settings.lifetime;
  risk.sections = settings.sections;
  risk.confidence = study.confidence;
  for (std::size_t g = 0; g < summary.fragility.size(); ++g) {
    const FragilityGroup& group = summary.fragility[g];
    if (group.intensity != risk.intensity || (!level.empty() && study.levels[group.level].name != level))
      continue;
    risk.levels.push_back(LevelFinder(study, risk, group).find());
    risk.levels.back().group = g;
  }
  risk.expected = expected_measures(study, summary, risk);
  return risk;
}

}  // namespace keyblock::study
