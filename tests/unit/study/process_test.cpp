#include "study/process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "../fresh_folder.h"
#include "core/atomic_file.h"

namespace keyblock::study {
namespace {

class Process : public testing::Test {
 protected:
  static std::string end_of(ChildProcess& child) {
    while (true) {
      if (const auto end = child.poll()) return *end;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  const FreshFolder folder;
  const std::filesystem::path log = folder / "log";
};

TEST_F(Process, HowItEnds) {
  ChildProcess good({"/bin/sh", "-c", "echo said; echo so >&2"}, log);
  EXPECT_EQ(end_of(good), "");
  EXPECT_EQ(read_file(log), "said\nso\n");
  ChildProcess bad({"/bin/sh", "-c", "exit 3"}, log);
  EXPECT_EQ(end_of(bad), "exit code 3");
  ChildProcess killed({"/bin/sh", "-c", "kill -SEGV $$"}, log);
  EXPECT_EQ(end_of(killed), "killed by signal 11 (SIGSEGV)");
  ChildProcess none({"/no/such/program"}, log);
  EXPECT_EQ(end_of(none), "exit code 127");
}

TEST_F(Process, WritesToItsParent) {
  ChildProcess child({"/bin/sh", "-c", "printf 12345678 >&$0", "{}"}, log);
  EXPECT_EQ(end_of(child), "");
  char text[9] = {};
  EXPECT_EQ(::read(child.pipe(), text, 8), 8);
  EXPECT_STREQ(text, "12345678");
}

TEST_F(Process, IsInterruptedAndEndsWithItsOwner) {
  ChildProcess child({"/bin/sleep", "60"}, log);
  child.interrupt();
  EXPECT_EQ(end_of(child), "killed by signal 2 (SIGINT)");
  pid_t id = 0;
  {
    const ChildProcess other({"/bin/sleep", "60"}, log);
    id = other.id();
    EXPECT_EQ(::kill(id, 0), 0);
  }
  EXPECT_NE(::kill(id, 0), 0);
}

}  // namespace
}  // namespace keyblock::study
