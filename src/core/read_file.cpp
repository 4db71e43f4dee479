#include "core/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace keyblock {
namespace {

constexpr std::size_t piece = std::size_t{1} << 20U;

class Reader {
 public:
  Reader(const std::filesystem::path& path, std::size_t largest, int flags) : path_(path), largest_(largest) {
    // Without waiting for somebody who writes into a pipe.
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | flags);
    if (descriptor_ >= 0) return;
    if (errno == ELOOP && (flags & O_NOFOLLOW) != 0) refuse("a link", "a file that keyblock has written");
    refuse_for_system();
  }
  ~Reader() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  std::string read() {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) refuse_for_system();
    if (S_ISDIR(status.st_mode)) refuse("a folder", "a file");
    if (!S_ISREG(status.st_mode)) refuse("a device or pipe", "a file");
    check_size(static_cast<std::size_t>(status.st_size));
    std::string content;
    for (std::size_t size = 0;;) {
      // The file may grow while it is read.
      content.resize(std::clamp(static_cast<std::size_t>(status.st_size), size + 1, size + piece));
      const ssize_t n = ::read(descriptor_, content.data() + size, content.size() - size);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) refuse_for_system();
      size += static_cast<std::size_t>(n);
      check_size(size);
      if (n > 0) continue;
      content.resize(size);
      return content;
    }
  }

 private:
  void check_size(std::size_t size) const {
    if (size <= largest_) return;
    refuse(fmt::format("a file of {:.0f} MB", static_cast<double>(size) / 1e6),
           fmt::format("at most {:.0f} MB", static_cast<double>(largest_) / 1e6));
  }

  [[noreturn]] void refuse(std::string found, std::string expected) const {
    Diagnostic diagnostic;
    diagnostic.where.file = path_.string();
    diagnostic.found = std::move(found);
    diagnostic.expected = std::move(expected);
    throw InputError(std::move(diagnostic));
  }
  [[noreturn]] void refuse_for_system() const {
    refuse(fmt::format("no readable file ({})", std::strerror(errno)), "a file that can be read");
  }

  const std::filesystem::path& path_;
  std::size_t largest_;
  int descriptor_ = -1;
};

}  // namespace

std::string read_file(const std::filesystem::path& path, std::size_t largest) {
  return Reader(path, largest, 0).read();
}

std::string read_own_file(const std::filesystem::path& path, std::size_t largest) {
  return Reader(path, largest, O_NOFOLLOW).read();
}

}  // namespace keyblock
