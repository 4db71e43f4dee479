#include "study/limit_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "record/standing.h"
#include "scenario/key_path.h"
#include "study/limit_statistics.h"
#include "study/measures.h"

namespace keyblock::study {
namespace {

using record::Standing;
using Status = Bisection::Status;

constexpr std::size_t most_lines = 20;  // of realizations, in the text
constexpr double told_way = 0.001;      // m, that blocks which stand have moved by
constexpr int least_digits = 3, most_digits = 9, digits_of_others = 4, digits_to_run_again = 2;

/// What a limit over a key is; `_` stands for a name, which takes the place of `{}`.
struct Subject {
  std::string_view key, text;
};
constexpr Subject subjects[] = {
    {"safety.strength_factor", "the factor of safety"},
    {"safety.k_h", "the yield coefficient"},
    {"joints.strength_factor", "the factor of safety"},
    {"joint_set._.strength_factor", "the factor of safety of {}"},
    {"trace_map._.strength_factor", "the factor of safety of {}"},
    {"interface._.strength_factor", "the factor of safety of {}"},
    {"joints.friction", "the friction angle that is needed"},
    {"joint_set._.friction", "the friction angle that {} needs"},
    {"trace_map._.friction", "the friction angle that {} needs"},
    {"interface._.friction", "the friction angle that {} needs"},
    {"joints.cohesion", "the cohesion that is needed"},
    {"joint_set._.cohesion", "the cohesion that {} needs"},
    {"trace_map._.cohesion", "the cohesion that {} needs"},
    {"interface._.cohesion", "the cohesion that {} needs"},
    {"excavation._.pressure", "the support pressure that {} needs"},
    {"tilt", "the tilt at the limit"},
    {"load_factor", "the factor on the loads at the limit"},
    {"gravity", "the gravity at the limit"},
    {"stage._.scale", "the scale of the motion at the limit"},
    {"motion._.pga", "the peak horizontal acceleration at the limit"},
    {"motion._.pgv", "the peak horizontal velocity at the limit"},
    {"stage._.k_h", "the horizontal seismic coefficient at the limit"},
    {"stage._.k_v", "the vertical seismic coefficient at the limit"},
};

std::string subject_of(const LimitRequest& request) {
  const std::string& key = request.key;
  if (!request.of.empty() && request.key == safety_key) return "the factor of safety of " + request.of;
  const auto segments = scenario::parse_key_path(key);
  for (const Subject& subject : subjects) {
    const auto pattern = scenario::parse_key_path(subject.key);
    if (!segments || !pattern || segments->size() != pattern->size()) continue;
    std::string name;
    const bool fits = std::equal(segments->begin(), segments->end(), pattern->begin(),
                                 [&](const auto& segment, const auto& of_pattern) {
                                   if (of_pattern.key == "_") name = segment.key;
                                   return of_pattern.key == "_" || of_pattern.key == segment.key;
                                 });
    if (fits) return fmt::format(fmt::runtime(subject.text), "“" + name + "”");
  }
  return "the limit of " + key;
}

std::string capital(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text;
}

/// As many as tell the ends of a bracket apart.
int digits_of(const Bisection::Bracket& bracket) {
  const double size = std::max(std::abs(bracket.not_met), std::abs(bracket.met)),
               width = std::abs(bracket.met - bracket.not_met);
  if (!(size > 0.0 && width > 0.0)) return least_digits;
  return std::clamp(static_cast<int>(std::ceil(std::log10(size / width))) + 1, least_digits, most_digits);
}

std::string block_text(const LimitTrial& trial) {
  const std::string name =
      trial.heaviest.empty() ? fmt::format("block {}", trial.movers.heaviest) : "“" + trial.heaviest + "”";
  const double weight = trial.movers.heaviest_weight;
  return weight > 0.0 ? fmt::format("{} ({:.4g} kN/m)", name, 1e-3 * weight) : name;
}

/// Who does what: "block 3 (6797 kN/m) moves", "3 blocks (12.5 kN/m) have fallen, the heaviest block 292 (7.2 kN/m)".
std::string movers_text(const LimitTrial& trial) {
  const record::StandingWord& word = record::word_of(trial.standing);
  if (trial.standing == Standing::unsettled) return "no equilibrium is found";
  if (trial.standing == Standing::stands || trial.movers.heaviest < 0)
    return fmt::format("the blocks {}", word.several);
  const std::string way =
      trial.standing == Standing::rocks ? fmt::format(", moved by {:.2g} m", trial.movers.way) : "";
  if (trial.movers.blocks == 1) return fmt::format("{} {}{}", block_text(trial), word.one, way);
  return fmt::format("{} blocks ({:.4g} kN/m) {}{}, the heaviest {}", trial.movers.blocks,
                     1e-3 * trial.movers.weight, word.several, way, block_text(trial));
}

std::string measured_text(const LimitRequest& request, const LimitTrial& trial) {
  const Measure& m = measures()[find_measure(request.criterion.measure).value()];
  return fmt::format("{} is {:.3g}{}{}", m.title, trial.measure, m.unit.empty() ? "" : " ", m.unit);
}

/// A limit and the ends of its bracket.
struct Limit {
  const LimitResult& result;
  const Bisection::Bracket& bracket;

  [[nodiscard]] std::string middle() const {
    return quantity(bracket.middle(), result.unit, digits_of(bracket));
  }
  /// An end of the bracket. Where outcomes come and go with the key, near enough for a run of the same one.
  [[nodiscard]] std::string end(double value) const {
    const int more = result.request.scan > 1 ? digits_to_run_again : 0;
    return quantity(value, result.unit, digits_of(bracket) + more);
  }
};

/// "It ends to hold at 7.0 and holds again from 9.1 on."
std::string other_limits(const LimitResult& result, const RealizationLimit& limit) {
  const auto& all = limit.state.limits;
  const std::size_t first = limit.is_bracketed() ? 1 : 0;
  if (all.size() <= first) return {};
  const double way = result.request.to - result.request.from;
  std::string text;
  for (std::size_t k = first; k < all.size(); ++k) {
    const bool begins = (all[k].met - all[k].not_met) * way > 0.0;
    text += fmt::format("{} {} at {}", text.empty() ? "" : ",", begins ? "holds again" : "ceases to hold",
                        Limit{result, all[k]}.middle());
  }
  return fmt::format(" There are {} limits: beyond the first the criterion{}.", all.size(), text);
}

/// What a scan does not see.
std::string scan_text(const LimitResult& result, const RealizationLimit& limit) {
  const LimitRequest& request = result.request;
  if (request.scan <= 1 || !limit.found()) return {};
  return fmt::format(
      " The scan looked every {}: what holds in a narrower range is not seen, and more parts look more "
      "often.",
      quantity(std::abs(request.to - request.from) / request.scan, result.unit, least_digits));
}

/// What blocks do before the criterion holds.
std::string already_text(const LimitResult& result, const RealizationLimit& limit) {
  if (!limit.moves) return {};
  const char* instead = result.request.key == safety_key ? "without an area this is asked for"
                                                         : "--until collapsed asks for that";
  return fmt::format("at {} already {}; {}", quantity(limit.moves->value, result.unit, digits_of_others),
                     movers_text(*limit.moves), instead);
}

std::string pga_text(const RealizationLimit& limit) {
  const LimitTrial* beyond = limit.just_beyond();
  if (beyond == nullptr || !(beyond->pga > 0.0) || beyond->value == 0.0) return {};
  return fmt::format(" (PGA {:.3g} m/s²)", beyond->pga * limit.limit() / beyond->value);
}

/// "The factor of safety is 1.29: the rock holds to 1.278, moves from 1.295 (…) and falls from 1.304 (…)."
std::string both_ends_text(const LimitResult& result, const RealizationLimit& limit) {
  const Bisection::Bracket bracket{limit.state.not_met, limit.state.met};
  const Limit words{result, bracket};
  const auto from = [&](const char* does, const LimitTrial& trial) {
    return fmt::format("{} from {} ({})", does, words.end(trial.value), outcome_text(result.request, trial));
  };
  const LimitTrial& beyond = *limit.just_beyond();
  const bool falls_at_once = limit.falls && limit.falls->value == bracket.met;
  std::string ends = falls_at_once ? " and " + from("falls", beyond) : ", " + from("moves", beyond);
  if (!falls_at_once && limit.falls) ends += " and " + from("falls", *limit.falls);
  if (!limit.falls) ends += fmt::format(", and falls at no value up to {}", words.end(result.request.to));
  return fmt::format("{} is {}{}: the rock holds to {}{}.", capital(subject_of(result.request)),
                     words.middle(), pga_text(limit), words.end(bracket.not_met), ends);
}

std::string found_text(const LimitResult& result, const RealizationLimit& limit) {
  const Bisection::Bracket bracket{limit.state.not_met, limit.state.met};
  const Limit words{result, bracket};
  if (result.request.criterion.has_two_ends()) return both_ends_text(result, limit);
  const auto at = [&](double value) {
    const LimitTrial* trial = limit.trial_at(value);
    return trial == nullptr ? std::string()
                            : fmt::format("at {} {}", words.end(value), outcome_text(result.request, *trial));
  };
  return fmt::format("{} is {}{}: {}, {}.", capital(subject_of(result.request)), words.middle(),
                     pga_text(limit), at(bracket.not_met), at(bracket.met));
}

std::string one_text(const LimitResult& result, const RealizationLimit& limit) {
  const LimitRequest& request = result.request;
  if (!limit.error.empty()) return "a trial failed: " + limit.error;
  const auto end = [&](double value) { return quantity(value, result.unit, digits_of_others); };
  switch (limit.state.status) {
    case Status::found:
      return found_text(result, limit);
    case Status::met_at_both:
      return fmt::format("met at --from {} already", end(request.from));
    case Status::met_at_none:
      return fmt::format("not met up to --to {}", end(request.to));
    case Status::ends_swapped:
      return fmt::format("met at --from {}, not at --to {}", end(request.from), end(request.to));
    case Status::open:
      break;
  }
  return fmt::format("between {} and {} so far", end(limit.state.not_met), end(limit.state.met));
}

/// Of one of many: short.
std::string line_text(const LimitResult& result, const RealizationLimit& limit) {
  if (!limit.found()) return one_text(result, limit);
  return fmt::format("limit {:.5g}: not met at {:.6g}, met at {:.6g} ({} runs)", limit.limit(),
                     limit.state.not_met, limit.state.met, limit.trials.size());
}

std::string interval_text(const LimitResult& result, const LimitQuantile& quantile) {
  return fmt::format("{} … {}", result.number_text(quantile.limit.low),
                     result.number_text(quantile.limit.high));
}

/// "limits of 18 of 20 realizations: median 5.1 (95 % interval 4 … 6), …"
std::string quantiles_text(const LimitResult& result) {
  const auto& all = result.realizations;
  const auto found = std::count_if(all.begin(), all.end(), [](const auto& limit) { return limit.found(); });
  std::string text = fmt::format("limits of {} of {} realizations", found, all.size());
  const LimitQuantile median = result.median();
  if (!std::isfinite(median.limit.value)) return text + "\n";
  text += ": median " + result.number_text(median);
  if (std::isfinite(median.limit.low) && std::isfinite(median.limit.high))
    text += fmt::format(" ({:.0f} % interval {})", 100.0 * result.confidence, interval_text(result, median));
  text += "\nquantiles:";
  std::string before = " ";
  for (const LimitQuantile& quantile : result.quantiles()) {
    text += fmt::format("{}{:.0f} % {} ({})", before, 100.0 * quantile.p, result.number_text(quantile),
                        interval_text(result, quantile));
    before = ", ";
  }
  return text + "\n";
}

std::string estimate_text(const LimitResult& result, const statistics::Estimate& estimate, int digits) {
  std::string text = fmt::format("{:.{}g}", estimate.value, digits);
  if (std::isfinite(estimate.low) && std::isfinite(estimate.high))
    text += fmt::format(" ({:.0f} % interval {:.{}g} … {:.{}g})", 100.0 * result.confidence, estimate.low,
                        digits, estimate.high, digits);
  return text;
}

/// Mean, share below 1, and on which strengths they hang.
std::string statistics_text(const LimitResult& result) {
  const LimitMean mean = mean_limit(result);
  if (!std::isfinite(mean.mean.value)) return {};
  const char* bound = mean.at_least == mean.at_most ? (mean.at_least ? "about " : "")
                      : mean.at_least               ? "at least "
                                                    : "at most ";
  std::string text = fmt::format("mean {}{}", bound, estimate_text(result, mean.mean, digits_of_others));
  if (std::isfinite(mean.standard_deviation))
    text += fmt::format(", standard deviation {:.{}g}", mean.standard_deviation, least_digits);
  text += "\n";
  if (const auto failure = failure_share(result)) {
    text += fmt::format("probability of a factor below 1: {}, {} of {}",
                        estimate_text(result, failure->share, least_digits), failure->below, failure->n);
    text += "\n";
  }
  for (const Dependence& one : dependences(result))
    text += fmt::format(
        "{}: rank correlation {}, first-order index {}\n", strength_title(one.strength),
        estimate_text(result, one.rank_correlation, 2),
        std::isfinite(one.first_order.value) ? estimate_text(result, one.first_order, 2) : "not known");
  return text;
}

/// Whether a key pushes to one side or the other by its sign: coefficients of an earthquake, gravity and loads along an axis, inclination.
bool has_two_ways(const std::string& key) {
  if (key == "tilt" || key.ends_with(".k_h") || key.ends_with(".k_v")) return true;
  return key.ends_with("]") && (key.starts_with("gravity[") || key.starts_with("load["));
}

}  // namespace

std::string quantity(double value, const std::string& unit, int digits) {
  const auto number = [&](double x) { return fmt::format("{:.{}g}", x, digits); };
  if (unit == "°") return number(value) + "°";
  if (unit == "Pa") {
    for (const auto& [size, name] : {std::pair{1e9, "GPa"}, {1e6, "MPa"}, {1e3, "kPa"}})
      if (std::abs(value) >= size) return fmt::format("{} {}", number(value / size), name);
  }
  return number(value) + (unit.empty() ? "" : " " + unit);
}

std::string outcome_text(const LimitRequest& request, const LimitTrial& trial) {
  const LimitCriterion& criterion = request.criterion;
  if (criterion.by_standing) {
    const bool has_moved = trial.standing == Standing::stands && trial.measure > told_way;
    return movers_text(trial) + (has_moved ? fmt::format(", moved by up to {:.2g} m", trial.measure) : "");
  }
  const bool stands = trial.standing == Standing::stands;
  if (criterion.name == "fallen" && !(trial.measure > 0.0))
    return stands ? "no rock falls" : "no rock has fallen, and " + movers_text(trial);
  const std::string measured = measured_text(request, trial);
  return stands || trial.movers.heaviest < 0 ? measured : measured + " and " + movers_text(trial);
}

std::string answer_text(const LimitResult& result) {
  if (result.realizations.empty()) return {};
  if (result.realizations.size() == 1) {
    const RealizationLimit& limit = result.realizations.front();
    const std::string text = one_text(result, limit), already = already_text(result, limit);
    return text + (text.ends_with('.') || (already.empty() && limit.state.limits.empty()) ? "" : ".") +
           other_limits(result, limit) + scan_text(result, limit) +
           (already.empty() ? "" : " But " + already + ".");
  }
  const LimitQuantile median = result.median();
  if (!result.complete || !std::isfinite(median.limit.value)) return {};
  const auto text = [&](double value) {
    return std::isfinite(value) ? quantity(value, result.unit, digits_of_others) : std::string("not known");
  };
  const bool is_bound = median.at_least || median.at_most;
  return fmt::format("{} is {}{} in the median of {} realizations ({:.0f} % interval {} … {}).",
                     capital(subject_of(result.request)),
                     is_bound ? (median.at_least ? "at least " : "at most ") : "", text(median.limit.value),
                     result.realizations.size(), 100.0 * result.confidence, text(median.limit.low),
                     text(median.limit.high));
}

std::string limit_text(const LimitResult& result) {
  const LimitRequest& request = result.request;
  const std::string since =
      request.since.empty() ? "" : fmt::format(" since the end of \"{}\"", request.since);
  std::string text = fmt::format("{} until {}{}\n", request.key, request.criterion.text(), since);
  if (!request.criterion.why.empty()) text += request.criterion.why + "\n";
  if (request.has_rest) text += "judged after a rest until all is still\n";
  const auto& all = result.realizations;
  if (all.size() == 1) return text + answer_text(result) + "\n";
  for (std::size_t k = 0; k < std::min(all.size(), most_lines); ++k)
    text += fmt::format("realization {}: {}\n", all[k].realization, line_text(result, all[k]));
  if (all.size() > most_lines) text += fmt::format("and {} realizations more\n", all.size() - most_lines);
  if (!result.complete) return text;
  const std::string answer = answer_text(result);
  return text + quantiles_text(result) + statistics_text(result) + (answer.empty() ? "" : answer + "\n");
}

std::string not_met_hint(const LimitResult& result) {
  const RealizationLimit& limit = result.realizations.front();
  const auto is_known = [](const LimitTrial& trial) { return std::isfinite(trial.measure); };
  if (std::ranges::none_of(limit.trials, is_known))
    return fmt::format("this model has no {}: it is null in summary.json", result.request.criterion.measure);
  const std::string already = already_text(result, limit);
  if (!already.empty()) return already;
  if (limit.trials.front().state_hash == limit.trials.back().state_hash)
    return "both runs are the same to the last bit: the key has no effect on this model";
  // What pushes the wrong way holds the more, the farther --to is.
  const std::string other_way =
      has_two_ways(result.request.key)
          ? fmt::format(", or give it the other sign: {} acts to the other side then", result.request.key)
          : "";
  if (result.request.criterion.by_standing)
    return "move --to farther" + other_way + "; --scan N looks between the ends";
  return "move --to farther" + other_way +
         ", lower --above, let the last stage last longer, or ask --until collapsed";
}

}  // namespace keyblock::study
