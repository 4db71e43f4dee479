#pragma once
#include <vector>

#include "results/hdf5_file.h"
#include "results/run_data.h"

/// The group `elements` of a result file: what elements there are, and a row of what they carry for each frame. Runs without elements do not
/// have it.
namespace keyblock::results {

void write_element_catalogue(hid_t file, const record::ModelRecord& model);
/// Names and kinds are known by then; all else of model.elements is read. Throws RunError where they do not fit.
void read_element_catalogue(hid_t file, record::ModelRecord& model);

class ElementTable {
 public:
  ElementTable() = default;
  ElementTable(hid_t file, const record::ModelRecord& model);
  void append(const std::vector<record::ElementState>& elements);
  void flush();
  /// Into the frames, of which those are dropped that have no row.
  static void read(hid_t file, std::size_t elements, std::vector<record::Frame>& frames);

 private:
  std::size_t count_ = 0;
  hdf5::Handle group_;
  hdf5::Column<double> ends_;
  std::vector<hdf5::Column<double>> numbers_;  ///< as element_state_fields
  hdf5::Column<std::uint8_t> present_;
};

}  // namespace keyblock::results
