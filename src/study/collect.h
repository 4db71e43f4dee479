#pragma once
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "study/folder.h"
#include "study/plan.h"

namespace keyblock::study {

/// What is there of a study.
struct StudyFiles {
  std::vector<RunState> states;  ///< in the places of plan.runs
  std::optional<int> enough;     ///< realizations that [study.until] found enough (until.h)

  /// Whether the study asks for this run: it is wanted, and of a realization that is needed.
  [[nodiscard]] bool asked(const PlannedRun& run) const {
    return run.wanted && (!enough || run.realization < *enough);
  }
};

/// Reads the results of all wanted runs of realizations before `realizations`.
StudyFiles read_study_files(const std::filesystem::path& directory, const Plan& plan,
                            int realizations = std::numeric_limits<int>::max());

/// files.enough anew, after its states have changed.
void update_enough(const Plan& plan, StudyFiles& files);

/// Wanted runs that failed count as missing from now on, in the folder too, and so does what [study.until] concluded from their
/// failure: they are to be tried again, and until then nobody can say how many realizations are enough.
void forget_failures(const std::filesystem::path& directory, const Plan& plan, StudyFiles& files);

/// How many of the runs that are asked for are there, and which are not, each with its key and what is known of it.
struct StudyCount {
  std::size_t asked = 0, done = 0;
  std::vector<std::string> missing;  ///< keys
  std::vector<std::string> failed;   ///< `KEY: why`
  std::vector<std::string> damaged;  ///< the file, and what is wrong with it
  std::optional<int> enough;
  /// Of the precision that was asked for, where all runs have ended without it (until.h).
  std::string lacking;
};
StudyCount count_runs(const Plan& plan, const StudyFiles& files);

struct CollectReport {
  StudyCount count;
  std::vector<std::string> findings;  ///< what the study found (findings.h)
};

/// What readers need, by realization, then combination, then variant. Runs that failed are in it, with their error.
StudyData study_data(const Plan& plan, StudyFiles files);

/// What there is to say of these files; writes DIR/runs.csv, study.json, report.html (outputs.h). Throws RunError when they
/// cannot be written.
CollectReport gather(const std::filesystem::path& directory, const Plan& plan, StudyFiles files);

/// Gathers the runs that are there: reads DIR/plan.json and the results it names. Throws InputError when DIR holds no plan.
CollectReport collect(const std::filesystem::path& directory);

}  // namespace keyblock::study
