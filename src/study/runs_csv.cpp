#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "results/csv.h"
#include "study/study_json.h"

namespace keyblock::study {

namespace {

/// Names of all stages, in the order of the runs that have most of them.
std::vector<std::string> stage_names(const StudyData& study) {
  std::vector<std::string> names;
  for (const RunResult& run : study.runs)
    for (const StageMeasures& stage : run.stages)
      if (std::find(names.begin(), names.end(), stage.name) == names.end()) names.push_back(stage.name);
  return names;
}

std::vector<std::string> strength_names(const StudyData& study) {
  std::vector<std::string> names;
  for (const RunResult& run : study.runs)
    for (const auto& [name, value] : run.strengths)
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  return names;
}

const char* text_of(Marginal marginal) {
  switch (marginal) {
    case Marginal::yes:
      return "yes";
    case Marginal::no:
      return "no";
    case Marginal::unknown:
      break;
  }
  return "";
}

class Table {
 public:
  Table(const StudyData& study, const Summary& summary)
      : study_(study), summary_(summary), stages_(stage_names(study)), strengths_(strength_names(study)) {
    for (const std::size_t k : known_intensities(study)) intensities_.push_back(intensities()[k]);
  }

  std::string text() {
    header();
    for (std::size_t r = 0; r < study_.runs.size(); ++r) row(r);
    return std::move(out_);
  }

 private:
  void field(std::string_view text) {
    if (!out_.empty() && out_.back() != '\n') out_ += ',';
    out_ += results::csv_field(text);
  }

  template <typename T>
  void value(T x) {
    out_ += ',';
    fmt::format_to(std::back_inserter(out_), "{}", x);
  }

  /// Empty where there is no number.
  void known(double x) {
    if (std::isnan(x))
      out_ += ',';
    else
      value(x);
  }

  void header() {
    for (const char* name : {"key", "realization"}) field(name);
    for (const Axis& axis : study_.axes) field(axis.key);
    for (const char* name : {"variant", "status", "error", "wall_time_s", "steps", "blocks",
                             "unconverged_steps", "max_overlap_m", "energy_residual_ratio", "marginal"})
      field(name);
    for (const std::string& stage : stages_) {
      for (const Intensity& i : intensities_) field(stage + "." + i.name);
      for (const Measure& m : measures()) field(stage + "." + m.name);
    }
    for (const std::string& strength : strengths_) field(strength);
    out_ += '\n';
  }

  void row(std::size_t r) {
    const RunResult& run = study_.runs[r];
    field(run.key);
    value(run.realization);
    for (std::size_t a = 0; a < study_.axes.size(); ++a) {
      out_ += ',';
      if (a < run.values.size()) out_ += results::csv_field(plain_value(run.values[a]));
    }
    out_ += ',' + results::csv_field(run.variant);
    out_ += measured(study_, run).damage ? ",done" : ",failed";
    out_ += ',' + results::csv_field(run.error);
    value(run.wall_time);
    value(run.steps);
    value(run.blocks);
    value(run.unconverged_steps);
    value(run.max_overlap);
    value(run.energy_residual_ratio);
    out_ += ',';
    out_ += text_of(summary_.marginal[r]);
    for (std::size_t s = 0; s < stages_.size(); ++s) stage(run, s);
    for (const std::string& name : strengths_) {
      const auto found = std::ranges::find(run.strengths, name, &std::pair<std::string, double>::first);
      known(found == run.strengths.end() ? statistics::not_a_number : found->second);
    }
    out_ += '\n';
  }

  void stage(const RunResult& run, std::size_t s) {
    // Stages stand in the same place in nearly all runs.
    const StageMeasures* found = nullptr;
    if (s < run.stages.size() && run.stages[s].name == stages_[s]) found = &run.stages[s];
    for (std::size_t k = 0; k < run.stages.size() && found == nullptr; ++k)
      if (run.stages[k].name == stages_[s]) found = &run.stages[k];
    if (found == nullptr) {
      out_.append(intensities_.size() + measures().size(), ',');
      return;
    }
    for (const Intensity& i : intensities_) known(found->*(i.of));
    for (const Measure& m : measures()) known(m.of(found->damage));
  }

  const StudyData& study_;
  const Summary& summary_;
  std::vector<std::string> stages_;
  std::vector<Intensity> intensities_;  ///< that some run has
  std::vector<std::string> strengths_;  ///< that were drawn
  std::string out_;
};

}  // namespace

std::string runs_csv(const StudyData& study, const Summary& summary) {
  return Table(study, summary).text();
}

}  // namespace keyblock::study
