#include "core/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace keyblock {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& place, std::string found, std::string expected) {
  Diagnostic diagnostic;
  diagnostic.where.file = place.string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  throw InputError(std::move(diagnostic));
}

void check_folder_takes_files(const fs::path& folder) {
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(folder, std::strerror(errno), "a folder that can be written to");
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

// Whoever held the lock before may have taken the file away meanwhile: then others lock another file of this name.
bool is_file_of_name(int file, const fs::path& path) {
  struct stat opened = {};
  struct stat named = {};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

bool file_exists(const fs::path& path) {
  std::error_code error;
  const bool exists = fs::exists(path, error);
  if (error) refuse(path, error.message(), "a file that can be looked for");
  return exists;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    refuse(folder, error ? error.message() : "a file", "a folder, or a place where one can be made");
  }
  check_folder_takes_files(folder);
}

void check_can_write(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) refuse(file, "a folder", "the name of a file");
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) refuse(file, "no folder " + folder.string(), "a file in a folder");
  check_folder_takes_files(folder);
}

FileLock::FileLock(fs::path path, Afterwards afterwards) : path_(std::move(path)), afterwards_(afterwards) {
  do {
    if (file_ >= 0) ::close(file_);
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw RunError(fmt::format("{}: cannot create: {}", path_.string(), std::strerror(errno)));
    held_ = ::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  } while (held_ && !is_file_of_name(file_, path_));
  if (!held_) return;
  const std::string text = fmt::format("process {} on {}\n", ::getpid(), host_name());
  // Only for people; a full disk does not matter.
  static_cast<void>(::ftruncate(file_, 0) == 0 && ::write(file_, text.data(), text.size()) > 0);
}

FileLock::~FileLock() {
  std::error_code ignored;
  if (held_ && afterwards_ == Afterwards::remove_file) fs::remove(path_, ignored);
  if (file_ >= 0) ::close(file_);
}

std::string FileLock::holder() const {
  std::ifstream in(path_);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.empty() ? "another process" : text;
}

}  // namespace keyblock
