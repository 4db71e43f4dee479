#include "report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "report/frame_codec.h"
#include "report/page_data.h"
#include "report/viewer_template.h"
#include "synthetic_run.h"

namespace keyblock::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ViewerTemplate, HoldsEachMarkOnceAndNoAddressOfTheNetwork) {
  const std::string_view page = viewer_template();
  for (const char* mark : {"@@title@@", "@@header@@", "@@arrays@@"}) {
    EXPECT_NE(page.find(mark), std::string_view::npos) << mark;
    EXPECT_EQ(page.find(mark), page.rfind(mark)) << mark;
  }
  EXPECT_THAT(std::string(page), Not(HasSubstr("<link rel=\"stylesheet\"")));
  EXPECT_THAT(std::string(page), Not(HasSubstr("src=\"http")));
}

TEST(Report, IsTheSameForTheSameRun) {
  const results::RunData run = made_up::synthetic_run();
  EXPECT_EQ(render_report(run), render_report(run));
}

TEST(Report, TextOfTheUserCannotBecomeMarkup) {
  const std::string page = render_report(made_up::synthetic_run());
  EXPECT_THAT(page, HasSubstr("<title>Brick wall &lt;synthetic&gt; &amp; shaken</title>"));
  EXPECT_THAT(page, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(page, HasSubstr(R"(\u003c/script>\u003cb>)"));
  EXPECT_THAT(page, Not(HasSubstr("@@")));
}

TEST(Report, TextThatIsNoUtf8IsShownAllTheSame) {
  results::RunData run = made_up::synthetic_run({.frames = false});
  run.model.scenario = "# caf\xe9";
  EXPECT_THAT(render_report(run), HasSubstr("# caf\xef\xbf\xbd"));
}

TEST(Report, NumbersThatAreNoneBecomeNull) {
  results::RunData run = made_up::synthetic_run({.frames = false});
  run.run.max_overlap.depth = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(page_header(run, page_arrays(run)), HasSubstr("\"max_overlap_m\":null"));
}

TEST(Report, OfARunWithoutAnEndTellsNothingThatOnlyItsEndTells) {
  results::RunData run = made_up::synthetic_run({.frames = false, .interrupted = true});
  EXPECT_THAT(page_header(run, page_arrays(run)), HasSubstr("\"cut_off\":false"));
  run.cut_off = true;
  const std::string header = page_header(run, page_arrays(run));
  EXPECT_THAT(header, HasSubstr("\"cut_off\":true"));
  EXPECT_THAT(header, HasSubstr("\"open_close\":null"));
  EXPECT_THAT(header, HasSubstr("\"planned_duration\":10.0"));
  EXPECT_THAT(header, HasSubstr("\"stages\":[\"in situ\",\"excavated\",\"first earthquake\",\"after\"]"));
}

TEST(Report, SaysOfHowManyStepsThereAreRows) {
  results::RunData run = made_up::synthetic_run({.frames = false});
  const auto header = [&] { return page_header(run, page_arrays(run)); };
  run.steps.resize(3);
  run.steps[0].step = 20;
  run.steps[1].step = 25;
  run.steps[2].step = 35;
  run.steps[1].stage = run.steps[2].stage = 1;
  EXPECT_THAT(header(), HasSubstr("\"steps_between_rows\":10"));
  run.steps.clear();
  EXPECT_THAT(header(), HasSubstr("\"steps_between_rows\":0"));
}

TEST(Report, OfAnEmptyRunCanBeWritten) {
  EXPECT_THAT(render_report({}), HasSubstr("</html>"));
}

TEST(Report, LargeModelsGetFewerFrames) {
  results::RunData run = made_up::synthetic_run({.frames_per_stage = 150});
  const auto frames = [](const results::RunData& r) {
    const ArrayPack pack = page_arrays(r);
    for (const auto& entry : pack.entries())
      if (entry.name == "frame.time") return entry.count;
    return std::size_t{0};
  };
  EXPECT_EQ(run.frames.size(), 600U);
  EXPECT_GE(frames(run), 290U);
  EXPECT_LE(frames(run), 300U);
}

TEST(Report, DisplacementsAreFinerThanAnyPixel) {
  const results::RunData run = made_up::synthetic_run();
  EXPECT_LE(displacement_quantum(run), 1e-7 * 17.0 * 1.000001);
  results::RunData still = made_up::synthetic_run({.frames_per_stage = 2});
  for (auto& frame : still.frames)
    for (auto& u : frame.displacement) u = {u[0] * 1e-6F, u[1] * 1e-6F};
  double largest = 0.0;
  for (const auto& frame : still.frames)
    for (const auto& u : frame.displacement)
      largest = std::max({largest, std::abs(double{u[0]}), std::abs(double{u[1]})});
  EXPECT_DOUBLE_EQ(displacement_quantum(still), 1e-4 * largest);
}

TEST(Report, BlocksThatFlyFarAreNotHeldOnTheirWay) {
  results::RunData run = made_up::synthetic_run({.frames_per_stage = 2});
  run.frames.back().displacement[0] = {1e5F, 0.0F};
  const double quantum = displacement_quantum(run);
  EXPECT_LE(1e5 / quantum, most_quanta);
  EXPECT_LE(quantum, 1e-4);
}

TEST(Report, IsWrittenBesideNothingElse) {
  const FreshFolder directory;
  const results::RunData run = made_up::synthetic_run({.frames_per_stage = 2});
  write_report(run, directory);
  EXPECT_EQ(read_file(directory / "report.html"), render_report(run));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory), {}), 1);
  EXPECT_THROW(write_report(run, directory / "missing"), RunError);
}

}  // namespace
}  // namespace keyblock::report
