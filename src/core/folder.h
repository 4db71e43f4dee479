#pragma once
#include <filesystem>
#include <string>

namespace keyblock {

/// Whether there is something of this name. Throws InputError where that cannot be told: a folder above may not be entered.
bool file_exists(const std::filesystem::path& path);

/// Makes the folder if it is not there. Throws InputError when it cannot be made, is no folder, or cannot be written to.
void make_folder(const std::filesystem::path& folder);

/// For a folder of the program within one of its own: what lies behind a link there is somebody else's. Throws InputError.
void check_is_no_link(const std::filesystem::path& folder);

/// Makes one in a folder that is there, for what keyblock cleans on its own account: a link is refused as a file is.
void make_plain_folder(const std::filesystem::path& folder);

/// Throws InputError unless a file of this name can be written: before work whose result would be lost.
void check_can_write(const std::filesystem::path& file);

/// A file that is locked while the object lives. Of processes that want the same one locked, on any machine that sees it, one
/// gets it. Where the file system knows no locks, all do.
class FileLock {
 public:
  enum class Afterwards { keep_file, remove_file };
  /// Throws RunError when the file cannot be made, InputError when something else has its name: a link, or a file that is no lock.
  explicit FileLock(std::filesystem::path path, Afterwards afterwards = Afterwards::keep_file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  [[nodiscard]] bool held() const { return held_; }
  /// Who holds it, as far as is known: `process 1234 on HOST`.
  [[nodiscard]] std::string holder() const;
  /// Whether an object of this process holds it.
  [[nodiscard]] bool held_by_this_process() const;

 private:
  void lock();
  void check_is_lock() const;
  [[noreturn]] void refuse_foreign(const char* found) const;
  [[nodiscard]] std::string content() const;

  std::filesystem::path path_;
  Afterwards afterwards_;
  int file_ = -1;
  bool held_ = false;
};

}  // namespace keyblock
