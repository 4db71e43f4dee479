#include "core/own_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include "core/error.h"

namespace keyblock {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view temporary_end = ".tmp";
constexpr int most_tries = 1000;

fs::path temporary_path(const fs::path& path, pid_t process, int number) {
  const std::string which = number == 0 ? "" : fmt::format(".{}", number);
  return path.string() + fmt::format(".{}{}{}", process, which, temporary_end);
}

[[noreturn]] void fail_to_create(const fs::path& path) {
  throw RunError(fmt::format("{}: cannot create: {}", path.string(), std::strerror(errno)));
}

int create_new(const fs::path& path) {
  constexpr mode_t mode = 0644;
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
}

bool is_running(pid_t process) {
  return ::kill(process, 0) == 0 || errno != ESRCH;
}

// Reads a number at the place and goes on behind it.
int take_number(const std::string& text, std::size_t& at) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), number);
  if (error == std::errc{}) at = static_cast<std::size_t>(end - text.data());
  return number;
}

// Of the process that made a temporary file of this path; 0: the entry is none.
pid_t maker_of(const fs::path& entry, const fs::path& path) {
  const std::string begin = path.string() + ".", name = entry.string();
  if (!name.starts_with(begin)) return 0;
  std::size_t at = begin.size();
  const pid_t process = take_number(name, at);
  int number = 0;
  if (at < name.size() && name[at] == '.') number = take_number(name, ++at);
  return process > 0 && number >= 0 && name == temporary_path(path, process, number) ? process : 0;
}

}  // namespace

NewFile create_temporary(const fs::path& path) {
  for (int number = 0; number < most_tries; ++number) {
    NewFile file{temporary_path(path, ::getpid(), number), -1};
    file.descriptor = create_new(file.path);
    if (file.descriptor >= 0) return file;
    if (errno != EEXIST) break;
  }
  fail_to_create(path);
}

void remove_stale_temporaries(const fs::path& path) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(path.parent_path(), ignored)) {
    const pid_t process = maker_of(entry.path(), path);
    if (process == 0 || is_running(process)) continue;
    if (fs::is_regular_file(entry.symlink_status(ignored))) fs::remove(entry.path(), ignored);
  }
}

int create_anew(const fs::path& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail_to_create(path);
  const int descriptor = create_new(path);
  if (descriptor < 0) fail_to_create(path);
  return descriptor;
}

void sync_folder_of(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

}  // namespace keyblock
