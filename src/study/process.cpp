#include "study/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/own_file.h"

namespace keyblock::study {
namespace {

constexpr int cannot_run = 127;  // as the shell says it

// Between fork and exec: nothing but system calls.
[[noreturn]] void become(char* const* words, int null, int log, int pipe, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(cannot_run);
  ::setpgid(0, 0);
  ::dup2(null, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  ::fcntl(pipe, F_SETFD, 0);
  ::execv(words[0], words);
  ::_exit(cannot_run);
}

class Descriptor {
 public:
  Descriptor(int number, const std::string& what) : number_(number) {
    if (number < 0) throw RunError(fmt::format("{}: {}", what, std::strerror(errno)));
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return number_; }  // NOLINT(google-explicit-constructor)
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0)
    throw RunError(fmt::format("no pipe to a run: {}", std::strerror(errno)));
  Descriptor read_end(ends[0], ""), write_end(ends[1], "");
  const Descriptor null(::open("/dev/null", O_RDONLY | O_CLOEXEC), "/dev/null");
  const Descriptor log_file(create_anew(log), log.string());
  std::vector<std::string> words = command;
  for (std::string& word : words) {
    if (word == "{}") word = std::to_string(write_end);
  }
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = ::getpid();
  id_ = ::fork();
  if (id_ < 0) throw RunError(fmt::format("no process for a run: {}", std::strerror(errno)));
  if (id_ == 0) become(pointers.data(), null, log_file, write_end, parent);
  pipe_ = read_end.release();
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : id_(std::exchange(other.id_, -1)), pipe_(std::exchange(other.pipe_, -1)), ended_(other.ended_) {}

ChildProcess::~ChildProcess() {
  if (id_ > 0 && !ended_) {
    ::kill(id_, SIGKILL);
    while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  if (pipe_ >= 0) ::close(pipe_);
}

void ChildProcess::interrupt() const {
  if (!ended_) ::kill(id_, SIGINT);
}

std::optional<std::string> ChildProcess::poll() {
  int status = 0;
  const pid_t found = ::waitpid(id_, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR)) return std::nullopt;
  ended_ = true;
  if (found < 0) return fmt::format("lost: {}", std::strerror(errno));
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* name = ::sigabbrev_np(signal);
    return fmt::format("killed by signal {} ({})", signal, name == nullptr ? "?" : std::string("SIG") + name);
  }
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("exit code {}", WEXITSTATUS(status));
}

}  // namespace keyblock::study
