#include "results/element_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/error.h"

namespace keyblock::results {
namespace {

using hdf5::read_array;
using record::element_state_fields;
using record::ElementDescription;
using record::ElementState;

constexpr std::size_t numbers = std::size(element_state_fields);
constexpr std::size_t of_ends = 4;  // x and y of both

template <class T>
hdf5::Array<T> read_of_elements(hid_t group, const char* name, std::size_t width) {
  auto array = read_array<T>(group, name);
  if (array.width() != width)
    throw RunError(fmt::format("elements/{} does not fit the names of the elements", name));
  return array;
}

}  // namespace

void write_element_catalogue(hid_t file, const record::ModelRecord& model) {
  const std::size_t count = model.elements.size();
  if (count == 0) return;
  std::vector<std::string> name, kind;
  std::vector<double> limit, spacing, reference;
  std::vector<std::int32_t> block;
  for (const ElementDescription& e : model.elements) {
    name.push_back(e.name);
    kind.push_back(e.kind);
    limit.push_back(e.limit);
    spacing.push_back(e.spacing);
    reference.insert(reference.end(), {e.from.x, e.from.y, e.to.x, e.to.y});
    block.insert(block.end(), {e.from_block, e.to_block});
  }
  const hdf5::Handle group = hdf5::create_group(file, "elements");
  hdf5::write_strings(group, "name", name);
  hdf5::write_strings(group, "kind", kind);
  hdf5::write_array<double>(group, "limit", {count}, limit);
  hdf5::write_array<double>(group, "spacing", {count}, spacing);
  hdf5::write_array<double>(group, "reference", {count, 2, 2}, reference);
  hdf5::write_array<std::int32_t>(group, "block", {count, 2}, block);
}

void read_element_catalogue(hid_t file, record::ModelRecord& model) {
  const std::size_t count = model.elements.size();
  if (count == 0) return;
  const hdf5::Handle group = hdf5::open_group(file, "elements");
  const auto limit = read_of_elements<double>(group, "limit", 1);
  const auto reference = read_of_elements<double>(group, "reference", of_ends);
  const auto block = read_of_elements<std::int32_t>(group, "block", 2);
  if (limit.rows() != count || reference.rows() != count || block.rows() != count)
    throw RunError("elements/limit, reference and block do not fit the names of the elements");
  if (H5Lexists(group, "spacing", H5P_DEFAULT) > 0) {  // files of earlier versions do not have it
    const auto spacing = read_of_elements<double>(group, "spacing", 1);
    if (spacing.rows() != count) throw RunError("elements/spacing does not fit the names of the elements");
    for (std::size_t k = 0; k < count; ++k) model.elements[k].spacing = spacing.values[k];
  }
  const auto blocks = static_cast<std::int32_t>(model.blocks.size());
  for (std::size_t k = 0; k < count; ++k) {
    ElementDescription& e = model.elements[k];
    const double* xy = &reference.values[of_ends * k];
    e.limit = limit.values[k];
    e.from = {xy[0], xy[1]};
    e.to = {xy[2], xy[3]};
    e.from_block = block.values[2 * k];
    e.to_block = block.values[2 * k + 1];
    if (e.from_block < -1 || e.from_block >= blocks || e.to_block < -1 || e.to_block >= blocks)
      throw RunError("elements/block names blocks that the model does not have");
    if (!(e.limit > 0.0) || !(e.spacing > 0.0) || !std::isfinite(e.from.x + e.from.y + e.to.x + e.to.y))
      throw RunError("elements/limit, spacing or reference holds a number that cannot be");
  }
}

ElementTable::ElementTable(hid_t file, const record::ModelRecord& model) : count_(model.elements.size()) {
  if (count_ == 0) return;
  group_ = hdf5::open_group(file, "elements");
  ends_ = hdf5::Column<double>(group_, "ends", {count_, 2, 2});
  for (const auto& field : element_state_fields)
    numbers_.emplace_back(group_, field.name, std::vector<hsize_t>{count_});
  present_ = hdf5::Column<std::uint8_t>(group_, "present", {count_});
}

void ElementTable::append(const std::vector<ElementState>& elements) {
  if (elements.size() != count_) throw std::invalid_argument("a frame of other elements");
  if (count_ == 0) return;
  std::vector<double> row;
  for (const ElementState& e : elements) row.insert(row.end(), {e.from.x, e.from.y, e.to.x, e.to.y});
  ends_.append(row);
  for (std::size_t n = 0; n < numbers; ++n) {
    row.clear();
    for (const ElementState& e : elements) row.push_back(e.*element_state_fields[n].number);
    numbers_[n].append(row);
  }
  std::vector<std::uint8_t> present;
  for (const ElementState& e : elements) present.push_back(e.present ? 1 : 0);
  present_.append(present);
}

void ElementTable::flush() {
  if (count_ == 0) return;
  ends_.flush();
  for (auto& column : numbers_) column.flush();
  present_.flush();
}

void ElementTable::read(hid_t file, std::size_t elements, std::vector<record::Frame>& frames) {
  if (elements == 0) return;
  const hdf5::Handle group = hdf5::open_group(file, "elements");
  const auto ends = read_of_elements<double>(group, "ends", of_ends * elements);
  const auto present = read_of_elements<std::uint8_t>(group, "present", elements);
  std::array<hdf5::Array<double>, numbers> columns;
  std::size_t rows = std::min({frames.size(), ends.rows(), present.rows()});
  const bool is_new = H5Lexists(group, "utilization", H5P_DEFAULT) > 0;
  const std::size_t known = is_new ? numbers : record::first_new_element_state;
  for (std::size_t n = 0; n < known; ++n) {
    columns[n] = read_of_elements<double>(group, element_state_fields[n].name, elements);
    rows = std::min(rows, columns[n].rows());
  }
  frames.resize(rows);
  for (std::size_t f = 0; f < rows; ++f) {
    for (std::size_t k = 0; k < elements; ++k) {
      const std::size_t at = elements * f + k;
      const double* xy = &ends.values[of_ends * at];
      ElementState& e = frames[f].elements.emplace_back();
      e.from = {xy[0], xy[1]};
      e.to = {xy[2], xy[3]};
      e.present = present.values[at] != 0;
      for (std::size_t n = 0; n < known; ++n) e.*element_state_fields[n].number = columns[n].values[at];
    }
  }
}

}  // namespace keyblock::results
