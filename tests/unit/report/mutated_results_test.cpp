#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "../fresh_folder.h"
#include "../mutations.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "report/report.h"
#include "results/export.h"
#include "results/hdf5_file.h"
#include "results/result_writer.h"
#include "results/run_data.h"
#include "results/summary.h"
#include "synthetic_run.h"

// HDF5 does not give back all its memory where it finds a file damaged.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(readability-identifier-naming)
  return "leak:libhdf5";
}

namespace keyblock::results {
namespace {

/// A dataset that is changed by the functions of HDF5, so that all checksums hold.
class ChangedDataset {
 public:
  ChangedDataset(hid_t file, const std::string& name) : id_(H5Dopen2(file, name.c_str(), H5P_DEFAULT)) {}
  ~ChangedDataset() { H5Dclose(id_); }
  ChangedDataset(const ChangedDataset&) = delete;
  ChangedDataset& operator=(const ChangedDataset&) = delete;

  void put_odd_value(Mutations& mutations) {
    const hid_t type = H5Dget_type(id_), space = H5Dget_space(id_);
    const std::size_t size = H5Tget_size(type),
                      count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
    std::string bytes(count * size, '\0');
    if (H5Tis_variable_str(type) > 0) {
      const std::vector<const char*> odd(count, mutations.below(2) == 0 ? "" : "odd \xff");
      H5Dwrite(id_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, odd.data());
    } else if (!bytes.empty()) {
      H5Dread(id_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
      if (H5Tget_class(type) == H5T_FLOAT) {
        put(bytes, size, count, mutations.odd_number(), mutations);
      } else if (H5Tget_class(type) == H5T_INTEGER && size > 1) {
        const std::int64_t number = mutations.odd_count();
        std::memcpy(&bytes[size * mutations.below(count)], &number, size);
      } else {
        put_odd_text(bytes, mutations);
      }
      H5Dwrite(id_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
    }
    H5Sclose(space);
    H5Tclose(type);
  }

  void change_extent(Mutations& mutations) {
    const hid_t space = H5Dget_space(id_);
    std::vector<hsize_t> now(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
    H5Sget_simple_extent_dims(space, now.data(), nullptr);
    H5Sclose(space);
    constexpr hsize_t sizes[] = {0, 1, 3, 1000, hsize_t{1} << 33U, hsize_t{1} << 62U};
    if (now.empty()) return;
    now[0] = sizes[mutations.below(std::size(sizes))];
    H5Dset_extent(id_, now.data());
  }

 private:
  static void put(std::string& bytes, std::size_t size, std::size_t count, double number,
                  Mutations& mutations) {
    const auto single = static_cast<float>(number);
    char* place = &bytes[size * mutations.below(count)];
    if (size == sizeof(single)) std::memcpy(place, &single, size);
    if (size == sizeof(number)) std::memcpy(place, &number, size);
  }
  /// Numbers of JSON, or any byte.
  static void put_odd_text(std::string& bytes, Mutations& mutations) {
    const std::size_t digit = bytes.find_first_of("0123456789", mutations.below(bytes.size()));
    if (digit == std::string::npos || mutations.below(3) == 0) {
      bytes[mutations.below(bytes.size())] ^= static_cast<char>(1U << mutations.below(8));
    } else if (mutations.below(2) == 0) {
      bytes.replace(digit, 1, "-");
    } else {
      for (std::size_t k = digit; k < bytes.size() && bytes[k] >= '0' && bytes[k] <= '9'; ++k) bytes[k] = '9';
    }
  }

  hid_t id_;
};

class MutatedResults : public ::testing::Test {
 protected:
  MutatedResults() {
    made_up::SyntheticOptions options;
    options.columns = 3;
    options.rows = 3;
    options.frames_per_stage = 2;
    const RunData run = made_up::synthetic_run(options);
    ResultWriter writer(folder_);
    writer.begin(run.model);
    for (std::size_t k = 0; k < run.run.stages.size(); ++k) {
      const int stage = static_cast<int>(k);
      writer.stage_begin(stage, run.run.stages[k]);
      for (const auto& row : run.frames)
        if (row.stage == stage) writer.frame(row);
      for (const auto& row : run.contacts)
        if (row.stage == stage) writer.contacts(row);
      for (const auto& row : run.steps)
        if (row.stage == stage) writer.step(row);
      writer.stage_end(stage, run.run.stages[k]);
    }
    for (const auto& row : run.histories) writer.history(row);
    writer.end(run.run);
    bytes_ = read_file(path());
  }

  [[nodiscard]] std::filesystem::path path() const { return folder_ / "result.h5"; }

  void write(const std::string& bytes) const { std::ofstream(path(), std::ios::binary) << bytes; }

  /// All that is made of results. True when they could be read.
  [[nodiscard]] bool used() {
    static_cast<void>(has_ended_or_refused());
    try {
      const RunData run = read_run(folder_);
      static_cast<void>(report::render_report(run));
      static_cast<void>(summary_json(run.model, run.run));
      // One after the other, as they take most of the time.
      constexpr ExportFormat formats[] = {ExportFormat::vtk, ExportFormat::csv, ExportFormat::geojson};
      export_run(run, folder_ / "export", formats[uses_++ % std::size(formats)], true);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("result.h5"));
      return false;
    }
    return true;
  }

  std::string bytes_;

 private:
  [[nodiscard]] bool has_ended_or_refused() const {
    try {
      return has_ended(folder_);
    } catch (const InputError&) {
      return true;
    }
  }

  const FreshFolder folder_;
  std::size_t uses_ = 0;
};

TEST_F(MutatedResults, DamagedBytes) {
  const hdf5::QuietErrors quiet;
  for (int format = 0; format < 3; ++format) ASSERT_TRUE(used());
  Mutations mutations(1);
  int read = 0;
  constexpr int count = 150;
  for (int k = 0; k < count; ++k) {
    SCOPED_TRACE(k);
    write(mutations(bytes_));
    ASSERT_NO_THROW(read += used() ? 1 : 0);
  }
  EXPECT_LT(read, count);
}

TEST_F(MutatedResults, ValuesSizesAndDatasetsThatSomebodyMadeUp) {
  const hdf5::QuietErrors quiet;
  std::vector<std::string> names;
  const hid_t file = H5Fopen(path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  H5Lvisit(
      file, H5_INDEX_NAME, H5_ITER_INC,
      [](hid_t group, const char* name, const H5L_info_t*, void* list) {
        const hid_t object = H5Oopen(group, name, H5P_DEFAULT);
        if (H5Iget_type(object) == H5I_DATASET)
          static_cast<std::vector<std::string>*>(list)->emplace_back(name);
        H5Oclose(object);
        return herr_t{0};
      },
      &names);
  H5Fclose(file);
  ASSERT_GT(names.size(), 40U);
  Mutations mutations(2);
  constexpr int count = 300;
  int read = 0;
  for (int k = 0; k < count; ++k) {
    const std::string& name = names[mutations.below(names.size())];
    const std::string& other = names[mutations.below(names.size())];
    const std::size_t kind = mutations.below(8);
    SCOPED_TRACE(name + " " + std::to_string(kind) + " " + std::to_string(k));
    write(bytes_);
    const hid_t changed = H5Fopen(path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(changed, 0);
    if (kind == 0) {
      ChangedDataset(changed, name).change_extent(mutations);
    } else if (kind == 1) {
      H5Ldelete(changed, name.c_str(), H5P_DEFAULT);
      if (mutations.below(2) == 0)
        H5Lcreate_soft(("/" + other).c_str(), changed, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    } else {
      ChangedDataset(changed, name).put_odd_value(mutations);
    }
    H5Fclose(changed);
    ASSERT_NO_THROW(read += used() ? 1 : 0);
  }
  EXPECT_GT(read, count / 10);
  EXPECT_LT(read, count);
}

}  // namespace
}  // namespace keyblock::results
