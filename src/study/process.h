#pragma once
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keyblock::study {

/// A child process in a process group of its own (Ctrl-C reaches it through its parent alone) that is killed when its parent
/// dies. Its output goes to a file; it may write to its parent through a pipe.
class ChildProcess {
 public:
  /// The word `{}` of the command stands for the number of the pipe's descriptor in the child. Throws RunError when no process
  /// can be made; that the program cannot be run shows as exit code 127.
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills it if it has not ended, and waits.
  ~ChildProcess();

  [[nodiscard]] pid_t id() const { return id_; }
  [[nodiscard]] int pipe() const { return pipe_; }  ///< to read from; does not block
  void interrupt() const;                           ///< SIGINT
  /// How it ended: nothing while it runs, "" for exit code 0, else `exit code 2`, `killed by signal 9 (Killed)`.
  std::optional<std::string> poll();

 private:
  pid_t id_ = -1;
  int pipe_ = -1;
  bool ended_ = false;
};

}  // namespace keyblock::study
