#include "study/study_json.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/checked_json.h"
#include "study/fragility_words.h"

namespace keyblock::study {

namespace {

using nlohmann::ordered_json;
using statistics::Estimate;

/// Six significant digits; null for what is not finite.
ordered_json number(double x) {
  if (!std::isfinite(x)) return nullptr;
  if (x == std::floor(x) && std::abs(x) < 1e6) return static_cast<int>(x);
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return std::strtod(text, nullptr);
}

template <typename Range, typename Member>
ordered_json column(const Range& range, Member member) {
  ordered_json values = ordered_json::array();
  for (const auto& x : range) values.push_back(number(member(x)));
  return values;
}

ordered_json estimate(const Estimate& e) {
  return {{"value", number(e.value)}, {"low", number(e.low)}, {"high", number(e.high)}};
}

/// Columns NAME, low, high.
void add_band(ordered_json& json, const char* name, const std::vector<Estimate>& estimates) {
  json[name] = column(estimates, [](const Estimate& e) { return e.value; });
  json["low"] = column(estimates, [](const Estimate& e) { return e.low; });
  json["high"] = column(estimates, [](const Estimate& e) { return e.high; });
}

ordered_json description_json(const statistics::Description& d) {
  ordered_json quantiles = ordered_json::array();
  for (std::size_t q = 0; q < summary_quantiles.size(); ++q) {
    ordered_json row{{"p", summary_quantiles[q]}};
    row.update(estimate(d.quantiles[q]));
    quantiles.push_back(row);
  }
  return {{"n", d.n},
          {"mean", estimate(d.mean)},
          {"std", estimate(d.standard_deviation)},
          {"min", number(d.min)},
          {"max", number(d.max)},
          {"quantiles", quantiles}};
}

ordered_json measure_json(const MeasureSummary& m) {
  ordered_json running{{"n", m.running.n}};
  add_band(running, "mean", m.running.mean);
  ordered_json exceedance{{"value", column(m.exceedance.value, [](double v) { return v; })}};
  add_band(exceedance, "probability", m.exceedance.above);
  ordered_json json = description_json(m.description);
  json["running_mean"] = running;
  json["exceedance"] = exceedance;
  return json;
}

ordered_json texts(const std::vector<std::string>& values) {
  ordered_json result = ordered_json::array();
  for (const std::string& v : values) result.push_back(plain_value(v));
  return result;
}

ordered_json key_of(const StudyData& study, const std::optional<std::size_t>& run) {
  return run ? ordered_json(study.runs[*run].key) : ordered_json(nullptr);
}

ordered_json share_json(const LevelSummary& share) {
  const Estimate& p = share.probability;
  return {{"n", share.n},
          {"exceeded", share.exceeded},
          {"probability", number(p.value)},
          {"low", number(p.low)},
          {"high", number(p.high)}};
}

ordered_json levels_json(const StudyData& study, const std::vector<LevelSummary>& levels) {
  ordered_json rows = ordered_json::array();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    rows.push_back({{"name", study.levels[l].name}});
    rows.back().update(share_json(levels[l]));
  }
  return rows;
}

ordered_json part_json(const StudyData& study, const std::optional<DamagePart>& part) {
  if (!part) return nullptr;
  ordered_json all = ordered_json::object();
  for (std::size_t m = 0; m < part->measures.size(); ++m)
    all[measures()[m].name] = description_json(part->measures[m]);
  return {
      {"falls", share_json(part->falls)}, {"levels", levels_json(study, part->levels)}, {"measures", all}};
}

ordered_json hangs_on_json(const Combination& c) {
  ordered_json rows = ordered_json::array();
  for (const Combination::OfMeasure& of : c.hangs_on) {
    for (const Dependence& one : of.dependences)
      rows.push_back({{"measure", of.measure},
                      {"strength", one.strength},
                      {"rank_correlation", estimate(one.rank_correlation)},
                      {"first_order_index", estimate(one.first_order)}});
  }
  return rows;
}

ordered_json combination_json(const StudyData& study, const Combination& c) {
  ordered_json json{{"values", texts(c.values)}, {"n", c.runs.size()}, {"failed", c.failed}};
  for (const std::size_t k : known_intensities(study)) json[intensities()[k].name] = number(c.intensity[k]);
  json["worst"] = key_of(study, c.worst);
  json["median"] = key_of(study, c.median);
  json["checked"] = c.checked;
  json["marginal"] = c.marginal;
  json["falls"] = share_json(c.falls);
  json["levels"] = levels_json(study, c.levels);
  ordered_json all = ordered_json::object();
  for (std::size_t m = 0; m < c.measures.size(); ++m) all[measures()[m].name] = measure_json(c.measures[m]);
  json["measures"] = all;
  json["before"] = part_json(study, c.before);
  json["added"] = part_json(study, c.added);
  json["hangs_on"] = hangs_on_json(c);
  json["map"] = {{"n", c.mapped}, {"fallen", c.fallen}, {"fallen_or_loosened", c.disturbed}};
  return json;
}

ordered_json fragility_json(const StudyData& study, const Summary& summary, const FragilityGroup& group) {
  ordered_json values = ordered_json::array();
  for (std::size_t a = 0; a < group.values.size(); ++a) {
    const bool shaking = a < summary.shaking_axis.size() && summary.shaking_axis[a];
    values.push_back(shaking ? ordered_json(nullptr) : ordered_json(plain_value(group.values[a])));
  }
  const auto& curve = group.curve;
  const std::string why = why_no_curve(study, group);
  const auto shown = [&](const Estimate& e) { return why.empty() ? e : Estimate{}; };
  ordered_json points{
      {"intensity", column(curve.stripes, [](const statistics::Stripe& s) { return s.intensity; })},
      {"n", column(curve.stripes, [](const statistics::Stripe& s) { return s.runs; })},
      {"exceeded", column(curve.stripes, [](const statistics::Stripe& s) { return s.exceeded; })},
      {"realizations", column(curve.stripes, [](const statistics::Stripe& s) { return s.clusters; })}};
  add_band(points, "probability", group.points);
  ordered_json band{{"intensity", column(curve.intensity, [](double x) { return x; })}};
  add_band(band, "probability", curve.probability);
  return {{"level", study.levels[group.level].name},
          {"intensity", intensities()[group.intensity].name},
          {"values", values},
          {"combinations", group.combinations},
          {"status", statistics::name_of(curve.status)},
          {"why", why.empty() ? ordered_json() : ordered_json(why)},
          {"theta", estimate(shown(curve.theta))},
          {"beta", estimate(shown(curve.beta))},
          {"realizations", curve.clusters},
          {"without_shaking", number(curve.at_rest.runs)},
          {"exceeded_without_shaking", number(curve.at_rest.exceeded)},
          {"records", curve.records},
          {"which_records", why.empty() ? ordered_json(for_which_records(curve)) : ordered_json()},
          {"sigma",
           {{"rock", estimate(shown(curve.split.rock))},
            {"record", estimate(shown(curve.split.record))},
            {"rest", estimate(shown(curve.split.rest))}}},
          {"pairs", curve.pairs},
          {"not_monotone", curve.not_monotone},
          {"points", points},
          {"curve", band}};
}

/// Also why a run that is done is not counted.
std::string error_of(const StudyData& study, const RunResult& run) {
  const bool lacks_control =
      study.control && run.error.empty() && damage_between(run, study.since, study.stage).has_value();
  return lacks_control ? "its control run, without shaking, failed or is missing" : run.error;
}

ordered_json failed_json(const StudyData& study) {
  ordered_json rows = ordered_json::array();
  for (const RunResult& run : study.runs) {
    if (measured(study, run).damage) continue;
    rows.push_back({{"key", run.key},
                    {"realization", run.realization},
                    {"values", texts(run.values)},
                    {"variant", run.variant},
                    {"error", error_of(study, run)}});
  }
  return rows;
}

ordered_json points(const std::vector<Vec2>& outline) {
  ordered_json rows = ordered_json::array();
  for (const Vec2 p : outline) rows.push_back({p.x, p.y});
  return rows;
}

ordered_json measures_json() {
  ordered_json all = ordered_json::array();
  for (const Measure& m : measures())
    all.push_back({{"name", m.name},
                   {"title", m.title},
                   {"unit", m.unit},
                   {"shown_unit", m.shown_unit},
                   {"shown_factor", m.shown_factor}});
  return all;
}

ordered_json head(const StudyData& study, const Summary& summary) {
  ordered_json axes = ordered_json::array();
  for (std::size_t a = 0; a < study.axes.size(); ++a)
    axes.push_back({{"key", study.axes[a].key},
                    {"values", texts(study.axes[a].values)},
                    {"shaking", static_cast<bool>(summary.shaking_axis[a])}});
  ordered_json levels = ordered_json::array();
  for (const DamageLevel& level : study.levels)
    levels.push_back(
        {{"name", level.name}, {"measure", level.measure}, {"threshold", number(level.threshold)}});
  ordered_json kinds = ordered_json::array();
  for (const std::size_t k : known_intensities(study)) {
    const Intensity& i = intensities()[k];
    kinds.push_back({{"name", i.name},
                     {"title", i.title},
                     {"unit", i.unit},
                     {"kind", i.kind},
                     {"component", i.component}});
  }
  int realizations = 0;
  {
    std::vector<int> all;
    for (const RunResult& run : study.runs) all.push_back(run.realization);
    std::sort(all.begin(), all.end());
    realizations = static_cast<int>(std::unique(all.begin(), all.end()) - all.begin());
  }
  ordered_json json{
      {"title", study.title},
      {"version", study.version},
      {"seed", study.seed},
      {"realizations", realizations},
      {"runs", {{"planned", study.planned}, {"done", summary.done}, {"failed", summary.failed}}},
      {"stage", study.stage},
      {"since", study.since.empty() ? ordered_json() : ordered_json(study.since)},
      {"before", study.before.empty() ? ordered_json() : ordered_json(study.before)},
      {"at_shaking", study.at_shaking},
      {"confidence", study.confidence},
      {"bootstrap_resamples", statistics::usual_resamples},
      {"axes", axes},
      {"levels", levels},
      {"measures", measures_json()},
      {"intensities", kinds}};
  json["precision"] = nullptr;
  if (study.precision) {
    const auto limit = [](const std::optional<double>& x) {
      return x ? ordered_json(*x) : ordered_json(nullptr);
    };
    json["precision"] = {{"measure", study.precision->measure},
                         {"half_width", limit(study.precision->half_width)},
                         {"width", limit(study.precision->width)},
                         {"minimum", study.precision->minimum},
                         {"reached", study.precision->reached}};
  }
  json["control"] = nullptr;
  if (study.control)
    json["control"] = {{"realizations", summary.control.realizations},
                       {"still_falling", summary.control.falling},
                       {"threshold_m2", number(summary.control.threshold)}};
  json["marginal"] = nullptr;
  if (study.marginal)
    json["marginal"] = {{"friction_degrees", study.marginal->friction},
                        {"share", study.marginal->share},
                        {"smallest_area_m2", smallest_marginal_area}};
  return json;
}

}  // namespace

std::string study_json(const StudyData& study, const Summary& summary) {
  ordered_json json = head(study, summary);
  ordered_json combinations = ordered_json::array();
  for (const Combination& c : summary.combinations) combinations.push_back(combination_json(study, c));
  json["combinations"] = std::move(combinations);
  ordered_json fragility = ordered_json::array();
  for (const FragilityGroup& group : summary.fragility)
    fragility.push_back(fragility_json(study, summary, group));
  json["fragility"] = std::move(fragility);
  // Six digits are too few for coordinates of a national grid.
  json["grid"] = {{"corner", {study.grid.corner.x, study.grid.corner.y}},
                  {"cell_m", study.grid.cell},
                  {"columns", study.grid.columns},
                  {"rows", study.grid.rows}};
  ordered_json outlines = ordered_json::array();
  for (const auto& outline : study.outlines) outlines.push_back(points(outline));
  json["outlines"] = std::move(outlines);
  ordered_json ground = ordered_json::array();
  for (const auto& [name, value] : study.ground) ground.push_back({{"name", name}, {"value", value}});
  json["ground"] = std::move(ground);
  json["failed"] = failed_json(study);
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace keyblock::study
