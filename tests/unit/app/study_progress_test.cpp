#include "study_progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyblock::app {
namespace {

using testing::HasSubstr;
using testing::Not;

study::StudyProgress sample() {
  study::StudyProgress p;
  p.total = 100;
  p.done = 41;
  p.failed = 1;
  p.running = 2;
  p.fraction = 0.42;
  p.seconds_left = 750.0;
  return p;
}

TEST(StudyBar, FitsTheTerminal) {
  Terminal terminal{true, true, false, 100};
  const std::string line = study_bar_line("limit", sample(), terminal);
  for (const char* part : {"limit", " 42 %", "41/100 done", "1 failed", "2 running", "ETA 12:30"})
    EXPECT_THAT(line, HasSubstr(part));
  for (int width = 1; width < 120; ++width) {
    terminal.width = width;
    EXPECT_LE(column_count(study_bar_line("limit", sample(), terminal)), width);
  }
}

TEST(StudyDisplay, LinesOfALogAreFarApartButFailuresAreAlwaysTold) {
  std::string text;
  double now = 0.0;
  StudyDisplay display(
      "limit", [&](const std::string& t) { text += t; }, [] { return Terminal{}; }, [&] { return now; });
  study::StudyProgress p = sample();
  display.show(p);
  EXPECT_EQ(text, "");  // nothing has ended
  p.finished = "r0001-a";
  display.show(p);
  EXPECT_EQ(text, "41/100 runs done, 1 failed, 2 running, 42 %, ETA 12:30\n");
  now = 1.0;
  display.show(p);
  EXPECT_EQ(text, "41/100 runs done, 1 failed, 2 running, 42 %, ETA 12:30\n");
  text.clear();
  p.failure = "exit code 2";
  display.show(p);
  EXPECT_EQ(text, "r0001-a failed: exit code 2\n");
  display.end();
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
}

}  // namespace
}  // namespace keyblock::app
