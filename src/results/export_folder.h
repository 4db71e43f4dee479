#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/file_set.h"

namespace keyblock::results {

/// A folder that exports are written into. It holds a list of their files, `keyblock-export.json`, by format, so that an export
/// takes the place of an earlier one of its format and touches nothing else.
class ExportFolder {
 public:
  /// Makes the folder where it is missing. Unless `replace`, throws InputError when it holds files but no list of exported ones.
  ExportFolder(std::filesystem::path folder, std::string format, bool replace);

  [[nodiscard]] FileSet& files() { return files_; }
  /// `written` appear, all of `files`, and what an earlier export of this format has left besides goes. Throws RunError when that
  /// fails, and, unless `replace`, InputError when one of them would take the place of a file that is of no export.
  void commit(const std::vector<std::filesystem::path>& written);

 private:
  void check_is_for_exports() const;
  void check_replaces_only_exports(const std::vector<std::filesystem::path>& written) const;

  std::filesystem::path folder_;
  std::string format_;
  bool replace_;
  FileSet files_;
  std::map<std::string, std::set<std::string>> exported_;  ///< by format
};

}  // namespace keyblock::results
