#pragma once
#include <filesystem>
#include <string>

#include "simulation/record.h"
#include "simulation/setup.h"

namespace keyblock::app {

/// Makes the folder if it is not there. Throws InputError when it cannot be made or is no folder.
void make_folder(const std::filesystem::path& folder);

/// Throws InputError when the folder holds results of a run, whose summary would be lost.
void check_holds_no_run(const std::filesystem::path& folder);

/// Guards the folder of a run's results. The input of a run is kept beside its results, in scenario.toml; a folder with
/// results of the same input may be written again (the results are the same), one with results of other input not.
class ResultFolder : public simulation::RunObserver {
 public:
  enum class Use { fresh, replace, resume };

  /// Throws InputError when `folder` holds results of other input, unless they are to be replaced. Nothing is changed yet.
  ResultFolder(std::filesystem::path folder, const simulation::RunSetup& setup, Use use);

  /// Whether there is something to go on from. A run that was stopped before its first checkpoint, or never started,
  /// begins anew, which leads to the same end.
  [[nodiscard]] bool resumes() const { return resumes_; }

  /// The run begins: unless it is resumed, keeps its input, and takes away what an earlier run had concluded.
  void begin(const simulation::ModelRecord& model) override;

 private:
  std::filesystem::path folder_;
  std::string input_;
  bool resumes_ = false;
};

}  // namespace keyblock::app
