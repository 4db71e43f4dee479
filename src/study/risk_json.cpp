#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "results/csv.h"
#include "study/estimate_json.h"
#include "study/fragility_words.h"
#include "study/risk.h"

namespace keyblock::study {
namespace {

using nlohmann::ordered_json;
using results::number_or_null;
using statistics::Estimate;

/// The axes that are not of shaking, and their values.
ordered_json values_json(const StudyData& study, const std::vector<std::string>& values) {
  ordered_json json = ordered_json::object();
  for (std::size_t a = 0; a < std::min(values.size(), study.axes.size()); ++a)
    if (!values[a].empty()) json[study.axes[a].key] = plain_value(values[a]);
  return json;
}

ordered_json hazard_json(const Hazard& hazard) {
  const statistics::HazardCurve& curve = hazard.found.curve;
  return {{"file", hazard.source.file.string()},
          {"hash", hazard.hash},
          {"intensity", hazard.found.intensity},
          {"component", hazard.source.component},
          {"weight", hazard.source.weight},
          {"intensities", curve.intensity},
          {"rates", curve.rate},
          {"end", curve.end ? ordered_json(*curve.end) : ordered_json(nullptr)}};
}

ordered_json level_json(const StudyData& study, const Summary& summary, const LevelRisk& level) {
  const FragilityGroup& group = summary.fragility[level.group];
  ordered_json by_hazard = ordered_json::array();
  for (const double rate : level.by_hazard) by_hazard.push_back(number_or_null(rate));
  const bool has_rate = !std::isnan(level.rate.value);
  return {
      {"level", study.levels[group.level].name},
      {"values", values_json(study, group.values)},
      {"status", name_of(level.status)},
      {"why", level.why.empty() ? ordered_json(nullptr) : ordered_json(level.why)},
      {"rate", estimate_json(level.rate)},
      {"which_records", has_rate ? ordered_json(for_which_records(group.curve)) : ordered_json(nullptr)},
      {"low_end", number_or_null(level.low_end)},
      {"high_end", number_or_null(level.high_end)},
      {"by_hazard", by_hazard},
      {"share_below_runs", number_or_null(level.share_below_runs)},
      {"share_above_runs", number_or_null(level.share_above_runs)},
      {"points", {{"low", number_or_null(level.points_low)}, {"high", number_or_null(level.points_high)}}},
      {"return_period", number_or_null(1.0 / level.rate.value)},
      {"annual", number_or_null(level.annual)},
      {"lifetime", number_or_null(level.lifetime)},
      {"lifetime_poisson", number_or_null(level.lifetime_poisson)},
      {"over_rock",
       {{"p05", number_or_null(level.p05)},
        {"p50", number_or_null(level.p50)},
        {"p95", number_or_null(level.p95)}}},
      {"sections",
       {{"low", number_or_null(level.sections_low)}, {"high", number_or_null(level.sections_high)}}},
      {"disaggregation",
       {{"p16", number_or_null(level.x16)},
        {"p50", number_or_null(level.x50)},
        {"p84", number_or_null(level.x84)}}}};
}

ordered_json expected_json(const StudyData& study, const ExpectedMeasure& expected) {
  return {{"measure", expected.measure},
          {"unit", measures()[*find_measure(expected.measure)].unit},
          {"values", values_json(study, expected.values)},
          {"status", name_of(expected.status)},
          {"why", expected.why.empty() ? ordered_json(nullptr) : ordered_json(expected.why)},
          {"value", number_or_null(expected.value.value)},
          {"low", number_or_null(expected.value.low)},
          {"high", number_or_null(expected.value.high)},
          {"below", number_or_null(expected.below)},
          {"beyond", number_or_null(expected.beyond)}};
}

std::string cell(double x) {
  return std::isfinite(x) ? fmt::format("{}", x) : "";
}

std::string name_of_group(const StudyData& study, const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t a = 0; a < std::min(values.size(), study.axes.size()); ++a)
    if (!values[a].empty())
      text += (text.empty() ? "" : ", ") + study.axes[a].key + " = " + plain_value(values[a]);
  return text;
}

/// "1,460 years" in three digits.
std::string years(double rate) {
  const double period = 1.0 / rate;
  return std::isfinite(period) ? fmt::format("{:.3g}", period) : "∞";
}

std::string per_cent(double p) {
  return fmt::format("{:.3g} %", 100.0 * p);
}

std::string interval_words(const Estimate& e, double confidence) {
  if (std::isnan(e.low)) return "";
  return fmt::format(" ({} … {}, {:.3g} % interval)", years(e.high), years(e.low), 100.0 * confidence);
}

std::string known_line(const Risk& risk, const LevelRisk& level, const statistics::FragilityCurve& curve) {
  std::string text =
      fmt::format("once in {} years{}, {}; in {:.4g} years with {}", years(level.rate.value),
                  interval_words(level.rate, risk.confidence), for_which_records(curve), risk.lifetime,
                  per_cent(std::isnan(level.lifetime) ? level.lifetime_poisson : level.lifetime));
  if (risk.sections > 1.0 && level.sections_low == level.sections_high)
    text += fmt::format("; at least one of {:.4g} sections once in {} years", risk.sections,
                        years(level.sections_low));
  else if (risk.sections > 1.0)
    text += fmt::format("; at least one of {:.4g} sections once in {} to {} years", risk.sections,
                        years(level.sections_high), years(level.sections_low));
  text += fmt::format("; from the points alone {} … {}", years(level.points_high), years(level.points_low));
  return level.why.empty() ? text : text + "; " + level.why;
}

std::string level_line(const StudyData& study, const Summary& summary, const Risk& risk,
                       const LevelRisk& level) {
  const FragilityGroup& group = summary.fragility[level.group];
  const std::string name = name_of_group(study, group.values);
  const std::string text = study.levels[group.level].name + (name.empty() ? "" : "; " + name) + ": ";
  switch (level.status) {
    case RiskStatus::step:
      return text + fmt::format("between once in {} and once in {} years, as {}", years(level.rate.high),
                                years(level.rate.low), level.why);
    case RiskStatus::upper_limit:
      return text + fmt::format("less than once in {} years, as {}", years(level.rate.high), level.why);
    case RiskStatus::no_curve:
      return text + "no rate, as " + level.why;
    default:
      return text + known_line(risk, level, group.curve);
  }
}

}  // namespace

std::string risk_json(const StudyData& study, const Summary& summary, const Risk& risk) {
  ordered_json json{{"title", study.title},           {"version", study.version},
                    {"confidence", risk.confidence},  {"lifetime_years", risk.lifetime},
                    {"section_count", risk.sections}, {"intensity", intensities()[risk.intensity].name}};
  json["hazard"] = ordered_json::array();
  for (const Hazard& hazard : risk.hazards) json["hazard"].push_back(hazard_json(hazard));
  json["levels"] = ordered_json::array();
  for (const LevelRisk& level : risk.levels) json["levels"].push_back(level_json(study, summary, level));
  json["expected"] = ordered_json::array();
  for (const ExpectedMeasure& expected : risk.expected)
    json["expected"].push_back(expected_json(study, expected));
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string risk_csv(const StudyData& study, const Summary& summary, const Risk& risk) {
  std::string text =
      "level,values,status,rate,rate_low,rate_high,return_period,annual,lifetime,lifetime_poisson,sections_"
      "low,"
      "sections_high,points_low,points_high,share_below_runs,share_above_runs\n";
  for (const LevelRisk& level : risk.levels) {
    const FragilityGroup& group = summary.fragility[level.group];
    text += results::csv_field(study.levels[group.level].name) + "," +
            results::csv_field(name_of_group(study, group.values)) + "," + name_of(level.status);
    for (const double x :
         {level.rate.value, level.rate.low, level.rate.high, 1.0 / level.rate.value, level.annual,
          level.lifetime, level.lifetime_poisson, level.sections_low, level.sections_high, level.points_low,
          level.points_high, level.share_below_runs, level.share_above_runs})
      text += "," + cell(x);
    text += "\n";
  }
  return text;
}

std::vector<std::string> risk_lines(const StudyData& study, const Summary& summary, const Risk& risk) {
  std::vector<std::string> lines;
  for (const LevelRisk& level : risk.levels) lines.push_back(level_line(study, summary, risk, level));
  for (const ExpectedMeasure& expected : risk.expected) {
    const Measure& measure = measures()[*find_measure(expected.measure)];
    const std::string name = name_of_group(study, expected.values);
    const double factor = measure.shown_factor;
    std::string text = fmt::format("{} a year{}: {:.3g} {}", measure.title, name.empty() ? "" : "; " + name,
                                   factor * expected.value.value, measure.shown_unit);
    if (!std::isnan(expected.value.low))
      text += fmt::format(" ({:.3g} … {:.3g})", factor * expected.value.low, factor * expected.value.high);
    lines.push_back(expected.why.empty() ? text : text + ", " + expected.why);
  }
  return lines;
}

}  // namespace keyblock::study
