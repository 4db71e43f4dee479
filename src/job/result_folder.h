#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/folder.h"
#include "simulation/setup.h"

namespace keyblock::job {

/// Throws InputError when the folder holds results of a run, whose summary would be lost.
void check_holds_no_run(const std::filesystem::path& folder);

/// Guards the folder of a run's results, for one process. The input of a run is kept beside its results, in scenario.toml, with
/// hashes of the files that it names; a folder with results of the same input may be written again (the results are the
/// same), one with results of other input not.
class ResultFolder {
 public:
  enum class Use { fresh, replace, resume };

  /// `inputs`: the files that the run reads. Throws InputError when
  ///   - one of them is a file that the run would write, or the folder is that of a study, or another process is at it;
  ///   - there are results of other input, or files named like results without them, unless they are to be replaced;
  ///   - a run is to be resumed whose results are gone.
  /// Nothing is changed yet, but that the folder is made, in it a file `lock` while the object lives, and that temporary files of
  /// runs that were killed are taken away.
  ResultFolder(std::filesystem::path folder, const std::vector<std::filesystem::path>& inputs,
               const simulation::RunSetup& setup, Use use);

  /// Whether there is something to go on from. A run that was stopped before its first checkpoint, or never started,
  /// begins anew, which leads to the same end.
  [[nodiscard]] bool resumes() const { return resumes_; }

  /// Whether the run that is to be resumed has come to its end already.
  [[nodiscard]] bool has_ended() const { return has_ended_; }

  /// New results are about to take the place of earlier ones: unless the run is resumed, keeps its input, and takes away what an
  /// earlier run had concluded.
  void enter();

  /// Others may work in the folder from now on.
  void let_go() { lock_.reset(); }

  /// Whether the folder holds results of this run, so far as there are any.
  [[nodiscard]] bool holds_this_run() const { return resumes_ || entered_; }

 private:
  void check_state(Use use) const;
  void check_steering() const;

  std::filesystem::path folder_;
  std::string input_;
  std::optional<FileLock> lock_;
  bool same_ = false;  ///< what is there is of the same input
  bool resumes_ = false, has_ended_ = false, entered_ = false;
};

}  // namespace keyblock::job
