#include "study/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "record/energy_warnings.h"
#include "study/fragility_words.h"

namespace keyblock::study {

namespace {

/// "stage.shaken.scale = 0.5, rock.order = 2"; empty texts are passed over.
std::string name_of(const StudyData& study, const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t a = 0; a < std::min(values.size(), study.axes.size()); ++a)
    if (!values[a].empty())
      text += (text.empty() ? "" : ", ") + study.axes[a].key + " = " + plain_value(values[a]);
  return text;
}

std::string share(const LevelSummary& level) {
  return fmt::format("{} of {} ({:.0f} … {:.0f} %)", level.exceeded, level.n, 100.0 * level.probability.low,
                     100.0 * level.probability.high);
}

std::string level_line(const StudyData& study, const Combination& c, std::size_t l) {
  const DamageLevel& level = study.levels[l];
  const std::string name = name_of(study, c.values);
  std::string text = fmt::format("{}: {} > {:.3g}{}{}: ", level.name, level.measure, level.threshold,
                                 name.empty() ? "" : "; ", name);
  if (!c.before) return text + share(c.levels[l]) + " realizations";
  if (study.since.empty()) text += share(c.levels[l]) + " realizations in all, ";
  const std::string until =
      study.at_shaking ? "before the shaking" : "until the end of \"" + study.before + '"';
  return text + share(c.before->levels[l]) + (study.since.empty() ? " " : " realizations ") + until + ", " +
         share(c.added->levels[l]) +
         (study.at_shaking ? " by what the shaking adds" : " by what comes after");
}

std::string curve_line(const StudyData& study, const FragilityGroup& group) {
  const Intensity& intensity = intensities()[group.intensity];
  const std::string name = name_of(study, group.values);
  const std::string text = fmt::format("curve of {} over {}{}{}: ", study.levels[group.level].name,
                                       intensity.title, name.empty() ? "" : ", ", name);
  const std::string why = why_no_curve(study, group);
  if (!why.empty()) return text + "none, as " + why;
  const auto interval = [](const statistics::Estimate& e) {
    return fmt::format("{:.3g} ({:.3g} … {:.3g})", e.value, e.low, e.high);
  };
  std::string line =
      text + fmt::format("median θ {} {}, β {}, {}", interval(group.curve.theta), intensity.unit,
                         interval(group.curve.beta), for_which_records(group.curve));
  const statistics::Split& split = group.curve.split;
  if (!std::isnan(split.rock.value))
    line += fmt::format("; σ of rock {:.2g}, of record {:.2g}, of the rest {:.2g}", split.rock.value,
                        split.record.value, split.rest.value);
  return line;
}

/// Empty where gravity had brought down what it could before the shaking.
std::string control_line(const Summary& summary) {
  const ControlSummary& control = summary.control;
  if (control.falling == 0) return {};
  return fmt::format(
      "in {} of {} realizations more than {:.3g} m2 came down in the run without shaking: gravity, which is "
      "taken off; a rest before the shaking with until = \"still\" lets it come down before",
      control.falling, control.realizations, control.threshold);
}

/// Empty where the balance of all runs closes.
std::string balance_line(const StudyData& study) {
  const auto is_doubtful = [](const RunResult& run) {
    return run.error.empty() && run.energy_residual_ratio > record::doubtful_residual;
  };
  const auto doubtful = std::ranges::count_if(study.runs, is_doubtful);
  if (doubtful == 0) return {};
  return fmt::format(
      "{} of {} runs: the balance of energies misses more than {:.0f} %, {}; see runs.csv", doubtful,
      study.runs.size(), 100.0 * record::doubtful_residual,
      std::ranges::find_if(study.runs, is_doubtful)->key + (doubtful > 1 ? " and others" : ""));
}

}  // namespace

std::vector<std::string> findings(const StudyData& study, const Summary& summary) {
  std::vector<std::string> lines;
  for (std::size_t l = 0; l < study.levels.size(); ++l)
    for (const Combination& c : summary.combinations)
      if (!c.runs.empty()) lines.push_back(level_line(study, c, l));
  for (const FragilityGroup& group : summary.fragility)
    if (group.intensity == 0) lines.push_back(curve_line(study, group));
  if (std::string line = control_line(summary); !line.empty()) lines.push_back(std::move(line));
  if (std::string line = balance_line(study); !line.empty()) lines.push_back(std::move(line));
  return lines;
}

}  // namespace keyblock::study
