#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../fresh_folder.h"
#include "core/error.h"
#include "debian_python.h"
#include "results/result_writer.h"
#include "results/run_data.h"
#include "sample_run.h"

namespace keyblock::results {
namespace {

using testing::HasSubstr;

void write(const std::filesystem::path& folder, SampleRun& sample) {
  ResultWriter writer(folder);
  sample.play(writer);
}

TEST(ElementTable, RunsWithoutElementsHaveNoneOfItsDatasets) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const FreshFolder folder;
  SampleRun sample;
  sample.model.elements.clear();
  sample.model.element_histories.clear();
  write(folder, sample);
  expect_equal(read_run(folder), sample.expected());
  const PythonResult names = python(folder, R"(
import sys, h5py
f = h5py.File(sys.argv[1] + "/result.h5", "r")
print(sorted(n for n in ("elements", "element", "end", "element_history", "histories/element_values") if n in f))
)",
                                    folder.string());
  EXPECT_EQ(names.output, "[]\n");
}

TEST(ElementTable, HistoriesOfElementsAloneAreWritten) {
  const FreshFolder folder;
  SampleRun sample;
  sample.model.history_names.clear();
  ResultWriter writer(folder);
  writer.begin(sample.model);
  record::HistoryRow row = sample.history(7);
  row.points.clear();
  writer.history(row);
  writer.end(sample.run());
  const RunData data = read_run(folder);
  ASSERT_EQ(data.histories.size(), 1u);
  EXPECT_EQ(data.histories[0].elements[0].force, row.elements[0].force);
  EXPECT_TRUE(std::filesystem::exists(folder / "histories.csv"));
}

// What is wrong with the file is said, and nothing is read beyond its end.
TEST(ElementTable, DatasetsThatDoNotFitAreRefused) {
  if (!python_has("h5py")) GTEST_SKIP() << "python3-h5py is not installed";
  const std::pair<const char*, const char*> damages[] = {
      {"f['elements/block'][0, 0] = 9", "blocks that the model does not have"},
      {"f['elements/limit'][0] = -1", "a number that cannot be"},
      {"del f['elements/force']", "force"},
      {"d = f['elements/present'][:, :1]; del f['elements/present']; f['elements/present'] = d", "present"},
      {"del f['elements/reference']; f['elements/reference'] = [[[1.0, 2.0], [3.0, 4.0]]]", "do not fit"},
      {"d = f['histories/element_values'][:, :, :1]; del f['histories/element_values']; "
       "f['histories/element_values'] = d",
       "element_values"}};
  for (const auto& [change, words] : damages) {
    const FreshFolder folder;
    SampleRun sample;
    write(folder, sample);
    const PythonResult done =
        python(folder,
               "import sys, h5py\nwith h5py.File(sys.argv[1] + '/result.h5', 'r+') as f:\n    " +
                   std::string(change) + "\n",
               folder.string());
    ASSERT_EQ(done.status, 0) << done.output;
    try {
      read_run(folder);
      ADD_FAILURE() << change;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words)) << change;
    }
  }
}

}  // namespace
}  // namespace keyblock::results
