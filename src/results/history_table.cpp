#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "record/record_fields.h"
#include "results/result_tables.h"
#include "results/table_rows.h"

namespace keyblock::results {
namespace {

using hdf5::Array;
using hdf5::read_array;
using hdf5::read_column;

constexpr std::size_t history_values = std::size(record::history_fields);
constexpr std::size_t element_values = record::element_history_fields.size();
constexpr std::size_t first_history_values = 7;  // of results of earlier versions

}  // namespace

HistoryTable::HistoryTable(hid_t file, const record::ModelRecord& model)
    : points_(model.history_names.size()),
      elements_(model.element_histories.size()),
      group_(hdf5::create_group(file, "histories")),
      values_(group_, "values", {points_, history_values}),
      step_(group_, "step", {}),
      time_(group_, "time", {}) {
  hdf5::write_strings(group_, "names", model.history_names);
  if (elements_ == 0) return;
  std::vector<std::string> names;
  for (const record::ElementHistory& history : model.element_histories) names.push_back(history.name);
  hdf5::write_strings(group_, "element_names", names);
  element_values_ = hdf5::Column<double>(group_, "element_values", {elements_, element_values});
}

void HistoryTable::append(const record::HistoryRow& row) {
  if (row.points.size() != points_ || row.elements.size() != elements_)
    throw std::invalid_argument("a history row of another model");
  values_.append_row(flat(reinterpret_cast<const double*>(row.points.data()), history_values * points_));
  std::vector<double> of_elements;
  for (const record::ElementState& element : row.elements) {
    for (const auto& field : record::element_history_fields) of_elements.push_back(element.*field.number);
  }
  if (elements_ > 0) element_values_.append(of_elements);
  step_.append(row.step);
  time_.append(row.time);
}

void HistoryTable::flush() {
  values_.flush();
  if (elements_ > 0) element_values_.flush();
  step_.flush();
  time_.flush();
}

namespace {

/// The next point of a file that has so many quantities of each; the others are not known.
record::HistoryRow::Point next_point(const double*& next, std::size_t quantities) {
  record::HistoryRow::Point point;
  for (std::size_t q = 0; q < history_values; ++q)
    point.*record::history_fields[q].member = q < quantities ? *next++ : std::nan("");
  return point;
}

record::ElementState next_element(const double*& next) {
  record::ElementState element;
  for (const auto& field : record::element_history_fields) element.*field.number = *next++;
  element.present = !std::isnan(element.force);
  return element;
}

}  // namespace

std::vector<record::HistoryRow> HistoryTable::read(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "histories");
  const auto time = read_column<double>(group, "time"), values = read_array<double>(group, "values");
  const auto step = read_column<std::int64_t>(group, "step");
  const std::size_t quantities = values.shape.size() == 3 ? values.shape[2] : 0;
  require(quantities == history_values || quantities == first_history_values, "histories/values");
  const std::size_t points = values.shape[1];
  const bool of_elements = H5Lexists(group, "element_values", H5P_DEFAULT) > 0;
  const auto elements = of_elements ? read_array<double>(group, "element_values") : Array<double>{};
  require(!of_elements || (elements.shape.size() == 3 && elements.shape[2] == element_values),
          "histories/element_values");
  std::vector<record::HistoryRow> rows(
      common_rows(time, {values.rows(), step.rows(), of_elements ? elements.rows() : values.rows()}));
  const double *next = values.values.data(), *of_element = elements.values.data();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].time = time.values[k];
    rows[k].step = step.values[k];
    for (std::size_t p = 0; p < points; ++p) rows[k].points.push_back(next_point(next, quantities));
    const std::size_t count = of_elements ? elements.shape[1] : 0;
    for (std::size_t e = 0; e < count; ++e) rows[k].elements.push_back(next_element(of_element));
  }
  return rows;
}

}  // namespace keyblock::results
