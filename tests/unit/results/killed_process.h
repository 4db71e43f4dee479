#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

namespace keyblock::results {

/// Runs `work` in a process that is killed when it returns, as by the kernel: nothing is closed.
inline void in_killed_process(const std::function<void()>& work) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    work();
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the work failed";
  ASSERT_EQ(WTERMSIG(status), SIGKILL);
}

}  // namespace keyblock::results
