#include "core/file_set.h"

#include <unistd.h>

#include <system_error>
#include <utility>

#include "core/folder.h"
#include "core/own_file.h"

namespace keyblock {

namespace fs = std::filesystem;

FileSet::FileSet(fs::path folder) : folder_(std::move(folder)) {
  std::error_code ignored;
  // A link that leads nowhere is not there for fs::exists, but is none of ours.
  const auto is_missing = [&](const fs::path& path) {
    return !fs::exists(fs::symlink_status(path, ignored));
  };
  for (fs::path path = folder_; !path.empty() && is_missing(path); path = path.parent_path())
    made_.push_back(path);
  try {
    make_folder(folder_);
  } catch (...) {
    remove_made_folders();
    throw;
  }
}

FileSet::~FileSet() {
  files_.clear();
  remove_made_folders();
}

// Those that hold something else by now stay.
void FileSet::remove_made_folders() {
  for (const fs::path& path : made_) ::rmdir(path.c_str());
}

AtomicFile& FileSet::add(const std::string& name) {
  const fs::path path = folder_ / name;
  check_can_write(path);
  return files_.emplace_back(path);
}

fs::path FileSet::write(const std::string& name, std::string_view content) {
  AtomicFile& file = add(name);
  file.write(content);
  file.close();
  return folder_ / name;
}

void FileSet::commit() {
  for (AtomicFile& file : files_) file.publish();
  made_.clear();
  if (!files_.empty()) sync_folder_of(folder_ / ".");
}

}  // namespace keyblock
