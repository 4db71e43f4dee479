#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <tuple>

#include "../fresh_folder.h"
#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/error.h"
#include "debian_python.h"
#include "results/export.h"
#include "results/result_writer.h"
#include "sample_run.h"

namespace keyblock::results {
namespace {

using testing::HasSubstr;

// The n-th piece of Python in docs/result-file.md.
std::string documented_python(int n) {
  const std::string page = read_file(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "docs" / "result-file.md");
  std::size_t begin = 0;
  for (int k = 0; k < n; ++k) begin = page.find("```python\n", begin) + 10;
  return page.substr(begin, page.find("```", begin) - begin);
}

// The example of docs/result-file.md, on a file whose run has ended and on one whose run has not.
TEST(ResultFileDocs, ThePythonExampleRuns) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const std::string script = documented_python(1);
  const FreshFolder folder;
  SampleRun sample;
  ResultWriter writer(folder, 0.0);
  sample.play(writer, 1, 26, false);
  PythonResult result = python(folder, script, folder.string());
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("realization 3\n"));
  EXPECT_THAT(result.output, HasSubstr("block 1 has fallen; it has 4 vertices and 1 holes"));
  {
    ResultWriter whole(folder);
    sample.play(whole);
  }
  result = python(folder, script, folder.string());
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("block 0 has fallen; it has 3 vertices and 0 holes"));
}

/// The folder of a run that has ended.
void write_sample(const std::filesystem::path& folder) {
  SampleRun sample;
  ResultWriter writer(folder);
  sample.play(writer);
}

TEST(ResultFileDocs, OutlinesOfBlocksInFourLines) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const std::string lines = documented_python(2);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 4);
  const FreshFolder folder;
  write_sample(folder);
  const PythonResult result =
      python(folder,
             "import sys, h5py\nf = h5py.File(sys.argv[1] + '/result.h5', 'r')\n" + lines +
                 "print([ring.tolist() for ring in outlines(1)], len(outlines(0)), outlines(2)[0].shape)\n",
             folder.string());
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(result.output,
            "[[[3.0, 3.0], [7.0, 3.0], [7.0, 7.0], [3.0, 7.0]], "
            "[[4.5, 4.5], [4.5, 5.5], [5.5, 5.5], [5.5, 4.5]]] 1 (3, 2)\n");
}

// Results of earlier versions have no acceleration.
TEST(ResultFileDocs, HistoriesOfSevenQuantitiesAreRead) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const FreshFolder folder;
  SampleRun sample;
  write_sample(folder);
  const std::string file = (folder / "result.h5").string();
  const PythonResult done = python(folder, R"(
import sys, h5py
with h5py.File(sys.argv[1], "r+") as f:
    old = f["histories/values"][:, :, :7]
    del f["histories/values"]
    f["histories/values"] = old
)",
                                   file);
  ASSERT_EQ(done.status, 0) << done.output;
  const RunData data = read_run(folder), as_written = sample.expected();
  ASSERT_EQ(data.histories.size(), as_written.histories.size());
  const auto &point = data.histories[3].points[1], &before = as_written.histories[3].points[1];
  EXPECT_EQ(point.ux, before.ux);
  EXPECT_EQ(point.sxy, before.sxy);
  EXPECT_TRUE(std::isnan(point.ax) && std::isnan(point.ay));
}

TEST(ResultFileDocs, EveryDatasetSaysItsUnitAndItsNames) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const FreshFolder folder;
  write_sample(folder);
  const PythonResult result = python(folder, R"(
import sys, h5py
f = h5py.File(sys.argv[1] + "/result.h5", "r")
def look(name, item):
    if not isinstance(item, h5py.Dataset): return
    a = item.attrs
    number = item.dtype.kind not in "SO" and not name in ("stages", "run", "summary", "texts")
    if "description" not in a or ("units" in a) != number: print("missing at", name)
    if "columns" in a and len(a["columns"]) != item.shape[-1]: print("columns of", name)
    units = len(a["units"].split(b", ")) if number else 1
    if units > 1 and units != item.shape[-1]: print("units of", name)
f.visititems(look)
for name in ("frames/status", "contacts/state", "model/edge_kind", "contacts/edge_kind", "model/block_fixed"):
    print(name, ", ".join(f[name].attrs["values"].astype("U")))
for name in ("frames/stress", "frames/velocity", "contacts/shear_force", "histories/values", "model/block_young",
             "steps/energy", "elements/force", "histories/element_values"):
    print(name, f[name].attrs["units"].decode())
print("/".join(f["steps/energy"].attrs["columns"].astype("U")) == b"/".join(f["steps/energy_names"][:]).decode())
)",
                                     folder.string());
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(result.output,
            "frames/status in place, loosened, fallen, excavated\n"
            "contacts/state open, sliding, locked\n"
            "model/edge_kind free, joint set, trace map, excavation, domain\n"
            "contacts/edge_kind free, joint set, trace map, excavation, domain\n"
            "model/block_fixed free, fixed\n"
            "frames/stress Pa\n"
            "frames/velocity m/s\n"
            "contacts/shear_force N/m\n"
            "histories/values m, m, m/s, m/s, Pa, Pa, Pa, m/s2, m/s2\n"
            "model/block_young Pa\n"
            "steps/energy J/m, J/m, J/m, J/m, J/m, J/m, J/m, J/m, 1, J/m, J/m\n"
            "elements/force N/m\n"
            "histories/element_values N/m, m\n"
            "True\n");
}

// Those of earlier versions have no velocities and do not know the stress normal to the section.
TEST(ResultFileDocs, FilesWithoutTheNewerDatasetsAreReadAndExported) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const FreshFolder folder;
  write_sample(folder);
  const PythonResult result = python(folder, R"(
import sys, h5py
with h5py.File(sys.argv[1] + "/result.h5", "r+") as f:
    del f["frames/velocity"], f["model/block_stress_ratio_zz"]
    del f["model/block_young"], f["model/block_poisson"]
)",
                                     folder.string());
  ASSERT_EQ(result.status, 0) << result.output;
  const RunData data = read_run(folder);
  ASSERT_FALSE(data.frames.empty());
  EXPECT_TRUE(data.frames.front().velocity.empty());
  EXPECT_EQ(data.frames.front().stress, SampleRun().expected().frames.front().stress);
  EXPECT_EQ(data.model.blocks.back().stress_ratio_zz, 0.0);
  EXPECT_TRUE(std::isnan(data.model.blocks.back().young));
  EXPECT_TRUE(std::isnan(data.model.blocks.back().poisson));
  export_run(data, folder / "vtk", ExportFormat::vtk);
  EXPECT_THAT(read_file(folder / "vtk/centres_00000.vtp"), testing::Not(HasSubstr("velocity")));
}

}  // namespace
}  // namespace keyblock::results
