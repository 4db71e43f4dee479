#include "progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyblock::app {
namespace {

using record::Progress;
using record::StageKind;
using record::StageRecord;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Terminal terminal(int width, bool unicode = true, bool color = false) {
  return {.interactive = true, .unicode = unicode, .color = color, .width = width};
}

Progress shaking() {
  Progress p;
  p.stage = 3;
  p.stage_count = 5;
  p.stage_name = "first earthquake";
  p.kind = StageKind::shake;
  p.step = 5800;
  p.fraction = 0.58;
  p.time = 11.6;
  p.steps_per_second = 511.7;
  p.seconds_left = 8.2;
  p.mean_iterations = 3.14;
  return p;
}

Progress settling() {
  Progress p = shaking();
  p.stage = 0;
  p.stage_name = "in situ";
  p.kind = StageKind::settle;
  p.worst_residual_ratio = 0.0423;
  return p;
}

StageRecord shaken() {
  StageRecord record;
  record.stage.name = "first earthquake";
  record.stage.kind = StageKind::shake;
  record.steps = 10000;
  record.duration = 20.0;
  record.wall_time = 19.6;
  return record;
}

TEST(ClockText, HoursOnlyWhereThereAreSome) {
  EXPECT_EQ(clock_text(0.0), "0:00");
  EXPECT_EQ(clock_text(9.4), "0:09");
  EXPECT_EQ(clock_text(59.6), "1:00");
  EXPECT_EQ(clock_text(3725.0), "1:02:05");
  EXPECT_EQ(clock_text(-1.0), "?");
  EXPECT_EQ(clock_text(std::nan("")), "?");
  EXPECT_EQ(clock_text(std::numeric_limits<double>::infinity()), "?");
}

TEST(BarLine, SaysEverythingWhereThereIsRoom) {
  EXPECT_EQ(bar_line(shaking(), terminal(101)),
            "4/5 first earthquake ━━━━━━━━━━━╸────────  "
            " 58 %  step 5800  11.60 s  512 steps/s  ETA 0:08  3.1 it.");
}

TEST(BarLine, LeavesOutTheLeastImportantFirst) {
  EXPECT_THAT(bar_line(shaking(), terminal(80)),
              EndsWith("─   58 %  step 5800  11.60 s  512 steps/s  ETA 0:08"));
  EXPECT_THAT(bar_line(shaking(), terminal(70)), EndsWith("─   58 %  step 5800  11.60 s  ETA 0:08"));
  EXPECT_THAT(bar_line(shaking(), terminal(50)), EndsWith("─   58 %  ETA 0:08"));
  EXPECT_THAT(bar_line(shaking(), terminal(38)), EndsWith("─   58 %"));
}

TEST(BarLine, FitsEveryWidth) {
  for (const bool unicode : {false, true}) {
    for (int width = 1; width < 200; ++width) {
      for (const Progress& p : {shaking(), settling(), Progress{}}) {
        EXPECT_LE(column_count(bar_line(p, terminal(width, unicode))), width - 1) << width;
      }
      EXPECT_LE(column_count(finished_line(3, 5, shaken(), shaking(), terminal(width, unicode))), width - 1);
    }
  }
}

TEST(BarLine, ShowsTheResidualWhileSettling) {
  const std::string line = bar_line(settling(), terminal(120));
  EXPECT_THAT(line, StartsWith("1/5 in situ "));
  EXPECT_THAT(line, HasSubstr("residual 4.2e-02"));
  EXPECT_THAT(line, Not(HasSubstr(" s  ")));
}

TEST(BarLine, FillsInProportion) {
  const auto filled = [](double fraction) {
    Progress p = shaking();
    p.fraction = fraction;
    const std::string line = bar_line(p, terminal(200, false));
    return std::count(line.begin(), line.end(), '#');
  };
  EXPECT_EQ(filled(0.0), 0);
  EXPECT_EQ(filled(0.5), 20);
  EXPECT_EQ(filled(1.0), 40);
  EXPECT_EQ(filled(7.0), 40);
  EXPECT_EQ(filled(-1.0), 0);
}

TEST(BarLine, NeverSaysHundredBeforeTheEnd) {
  Progress p = shaking();
  p.fraction = 0.9999;
  EXPECT_THAT(bar_line(p, terminal(120)), HasSubstr(" 99 %"));
}

TEST(BarLine, AsciiOnlyWhereTheLocaleIsNotUnicode) {
  Progress p = shaking();
  p.stage_name = "Erdbeben für später";
  const std::string line = bar_line(p, terminal(120, false));
  EXPECT_TRUE(std::all_of(line.begin(), line.end(), [](char c) { return c >= 0x20 && c < 0x7F; })) << line;
  EXPECT_THAT(line, StartsWith("4/5 Erdbeben f?r sp~ "));
  EXPECT_THAT(bar_line(p, terminal(120, true)), StartsWith("4/5 Erdbeben für sp… "));
}

TEST(BarLine, ColorsOnlyWhereWanted) {
  EXPECT_THAT(bar_line(shaking(), terminal(120, true, true)), HasSubstr("\x1b[32m━"));
  EXPECT_THAT(bar_line(shaking(), terminal(120, true, false)), Not(HasSubstr("\x1b")));
}

TEST(OneLine, CutsAndCleans) {
  EXPECT_EQ(one_line("shake", 5, true), "shake");
  EXPECT_EQ(one_line("shakes", 5, true), "shak…");
  EXPECT_EQ(one_line("shakes", 5, false), "shak~");
  EXPECT_EQ(one_line("äöüäöü", 4, true), "äöü…");
  EXPECT_EQ(one_line("a\x1b[31m\n", 10, true), "a?[31m?");
  EXPECT_EQ(one_line("abc", 0, true), "");
}

TEST(FinishedLine, SaysHowTheStageEnded) {
  StageRecord record = shaken();
  EXPECT_THAT(finished_line(3, 5, record, shaking(), terminal(120)),
              EndsWith("━  20.00 s  10000 steps  in 0:20  510 steps/s  3.1 it."));
  record.interrupted = true;
  EXPECT_THAT(finished_line(3, 5, record, shaking(), terminal(120)), HasSubstr("─  interrupted"));
  record.interrupted = false;
  record.stage.kind = StageKind::settle;
  EXPECT_THAT(finished_line(0, 5, record, settling(), terminal(120)),
              HasSubstr("━  not reached  10000 steps"));
  record.equilibrium_reached = true;
  EXPECT_THAT(finished_line(0, 5, record, settling(), terminal(120)),
              HasSubstr("━  in equilibrium  10000 steps"));
  record.moving = {{7, 0.0, 7}};
  EXPECT_THAT(finished_line(0, 5, record, settling(), terminal(120)), HasSubstr("━  1 block falling"));
  record.moving.resize(3, {8, 1.0, 8});
  EXPECT_THAT(finished_line(0, 5, record, settling(), terminal(120)),
              HasSubstr("━  mechanism of 2 blocks, 1 block falling"));
}

struct Screen {
  std::vector<std::string> writes;
  double now = 100.0;
  Terminal kind;

  ProgressObserver observer() {
    return {5, [this](const std::string& text) { writes.push_back(text); }, [this] { return kind; },
            [this] { return now; }};
  }
};

TEST(ProgressObserver, RedrawsOnATerminalAndLeavesFinishedBars) {
  Screen screen;
  screen.kind = terminal(80);
  ProgressObserver observer = screen.observer();
  observer.stage_begin(3, shaken());
  observer.progress(shaking());
  observer.progress(shaking());
  observer.stage_end(3, shaken());
  observer.end({});
  ASSERT_EQ(screen.writes.size(), 3U);
  EXPECT_THAT(screen.writes[1], StartsWith("\r"));
  EXPECT_THAT(screen.writes[1], Not(HasSubstr("\n")));
  EXPECT_THAT(screen.writes[2], StartsWith("\r"));
  EXPECT_THAT(screen.writes[2], EndsWith("\n"));
}

TEST(ProgressObserver, LeavesAnUnfinishedBarOnItsLine) {
  Screen screen;
  screen.kind = terminal(80);
  ProgressObserver observer = screen.observer();
  observer.progress(shaking());
  observer.end({});
  ASSERT_EQ(screen.writes.size(), 2U);
  EXPECT_EQ(screen.writes[1], "\n");
}

TEST(ProgressObserver, WritesALineNowAndThenToALog) {
  Screen screen;
  screen.kind = {.interactive = false, .unicode = true, .color = false, .width = 80};
  ProgressObserver observer = screen.observer();
  observer.stage_begin(3, shaken());
  for (int k = 0; k < 60; ++k) {
    screen.now += 0.2;
    observer.progress(shaking());
  }
  observer.stage_end(3, shaken());
  observer.end({});
  EXPECT_THAT(screen.writes,
              ElementsAre("4/5 first earthquake:  58 %, step 5800, 11.60 s, 512 steps/s, ETA 0:08, 3.1 it.\n",
                          "4/5 first earthquake:  58 %, step 5800, 11.60 s, 512 steps/s, ETA 0:08, 3.1 it.\n",
                          "4/5 first earthquake: 20.00 s, 10000 steps, in 0:20, 510 steps/s, 3.1 it.\n"));
}

}  // namespace
}  // namespace keyblock::app
