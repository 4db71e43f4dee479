#pragma once
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/atomic_file.h"

namespace keyblock {

/// Files of one folder that belong together: all of them appear, or none when something fails before `commit`. The folder is made
/// where it is missing, and goes again with those around it that were made for it when the object goes before `commit`.
class FileSet {
 public:
  /// Throws InputError as make_folder() does.
  explicit FileSet(std::filesystem::path folder);
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// A file to be written, by another thread too. Throws RunError as AtomicFile does, and InputError when a folder has its name.
  AtomicFile& add(const std::string& name);
  /// The same, written; returns the path that it will have.
  std::filesystem::path write(const std::string& name, std::string_view content);
  /// Throws RunError.
  void commit();

 private:
  void remove_made_folders();

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  ///< folders, the innermost first
  std::deque<AtomicFile> files_;
};

}  // namespace keyblock
