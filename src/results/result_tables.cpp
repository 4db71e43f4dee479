#include "results/result_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "core/error.h"
#include "record/record_fields.h"
#include "results/table_rows.h"

namespace keyblock::results {
namespace {

using hdf5::Array;
using hdf5::read_array;
using hdf5::read_column;

constexpr std::size_t energy_terms = std::size(record::energy_fields);
constexpr std::size_t first_energy_terms = 9;  // of results of the first version

static_assert(sizeof(Vec2) == 2 * sizeof(double));

}  // namespace

FrameTable::FrameTable(hid_t file, const record::ModelRecord& model)
    : vertices_(model.vertices.size()),
      blocks_(model.blocks.size()),
      elements_(file, model),
      group_(hdf5::create_group(file, "frames")),
      displacement_(group_, "displacement", {vertices_, 2}),
      stress_(group_, "stress", {blocks_, 3}),
      velocity_(group_, "velocity", {blocks_, 2}),
      status_(group_, "status", {blocks_}),
      order_(group_, "order", {blocks_}),
      stage_(group_, "stage", {}),
      step_(group_, "step", {}),
      time_(group_, "time", {}) {}

void FrameTable::append(const record::Frame& frame) {
  if (frame.displacement.size() != vertices_ || frame.stress.size() != blocks_ ||
      frame.status.size() != blocks_ || frame.order.size() != blocks_ ||
      (!frame.velocity.empty() && frame.velocity.size() != blocks_)) {
    throw std::invalid_argument("a frame of another model");
  }
  displacement_.append_row(flat(frame.displacement.data()->data(), 2 * vertices_));
  stress_.append_row(flat(frame.stress.data()->data(), 3 * blocks_));
  const std::vector<float> unknown(frame.velocity.empty() ? 2 * blocks_ : 0, std::nanf(""));
  velocity_.append_row(unknown.empty() ? flat(frame.velocity.data()->data(), 2 * blocks_) : unknown);
  std::vector<std::uint8_t> status;
  for (const record::BlockStatus s : frame.status) status.push_back(static_cast<std::uint8_t>(s));
  status_.append_row(status);
  order_.append_row(frame.order);
  elements_.append(frame.elements);
  stage_.append(frame.stage);
  step_.append(frame.step);
  time_.append(frame.time);
}

void FrameTable::flush() {
  displacement_.flush();
  stress_.flush();
  velocity_.flush();
  status_.flush();
  order_.flush();
  elements_.flush();
  stage_.flush();
  step_.flush();
  time_.flush();
}

std::vector<record::Frame> FrameTable::read(hid_t file, const record::ModelRecord& model) {
  const hdf5::Handle group = hdf5::open_group(file, "frames");
  const auto time = read_column<double>(group, "time");
  const auto displacement = read_array<float>(group, "displacement"),
             stress = read_array<float>(group, "stress");
  // Files of version 0.1 may have none.
  const bool has_velocity = H5Lexists(group, "velocity", H5P_DEFAULT) > 0;
  const auto velocity = has_velocity ? read_array<float>(group, "velocity") : Array<float>{};
  const auto status = read_array<std::uint8_t>(group, "status");
  const auto order = read_array<std::int16_t>(group, "order");
  const auto stage = read_column<std::int32_t>(group, "stage");
  const auto step = read_column<std::int64_t>(group, "step");
  const std::size_t nv = displacement.width() / 2, nb = status.width();
  require(stress.width() == 3 * nb, "frames/stress");
  require(order.width() == nb, "frames/order");
  require(!has_velocity || velocity.width() == 2 * nb, "frames/velocity");
  std::vector<record::Frame> frames(
      common_rows(time, {displacement.rows(), stress.rows(), status.rows(), order.rows(), stage.rows(),
                         step.rows(), has_velocity ? velocity.rows() : displacement.rows()}));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    record::Frame& frame = frames[f];
    frame.time = time.values[f];
    frame.stage = stage.values[f];
    frame.step = step.values[f];
    frame.displacement.resize(nv);
    frame.stress.resize(nb);
    if (nv > 0) std::copy_n(&displacement.values[2 * nv * f], 2 * nv, frame.displacement.front().data());
    if (nb > 0) std::copy_n(&stress.values[3 * nb * f], 3 * nb, frame.stress.front().data());
    if (has_velocity && nb > 0) {
      frame.velocity.resize(nb);
      std::copy_n(&velocity.values[2 * nb * f], 2 * nb, frame.velocity.front().data());
    }
    const auto orders = std::span(order.values).subspan(nb * f, nb);
    frame.order.assign(orders.begin(), orders.end());
    for (std::size_t b = 0; b < nb; ++b) {
      frame.status.push_back(
          enumerator(status.values[nb * f + b], record::BlockStatus::excavated, "frames/status"));
    }
  }
  ElementTable::read(file, model.elements.size(), frames);
  return frames;
}

StepTable::StepTable(hid_t file)
    : rows_(file, "steps", record::step_fields), energy_(rows_.group(), "energy", {energy_terms}) {
  hdf5::write_strings(rows_.group(), "energy_names", record::energy_names());
}

void StepTable::append(const record::StepRow& row) {
  std::array<double, energy_terms> energy{};
  for (std::size_t k = 0; k < energy_terms; ++k) energy[k] = row.energy.*record::energy_fields[k].number;
  energy_.append(energy);
  rows_.append(row);
}

void StepTable::flush() {
  energy_.flush();
  rows_.flush();
}

std::vector<record::StepRow> StepTable::read(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "steps");
  std::vector<record::StepRow> rows =
      TableOf<decltype(record::step_fields)>::read(group, record::step_fields);
  const auto energy = read_array<double>(group, "energy");
  const std::size_t terms = energy.width();
  require(terms >= first_energy_terms && terms <= energy_terms, "steps/energy");
  rows.resize(std::min(rows.size(), energy.rows()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t i = 0; i < terms; ++i)
      rows[k].energy.*record::energy_fields[i].number = energy.values[terms * k + i];
  }
  return rows;
}

BreakTable::BreakTable(hid_t file, const record::ModelRecord& model) {
  if (model.may_break) rows_.emplace(file, "breaks", record::break_fields);
}

void BreakTable::append(const record::BreakRecord& row) {
  if (!rows_) throw std::invalid_argument("a break in a model in which nothing may break");
  rows_->append(row);
}

void BreakTable::flush() {
  if (rows_) rows_->flush();
}

std::vector<record::BreakRecord> BreakTable::read(hid_t file) {
  if (H5Lexists(file, "breaks", H5P_DEFAULT) <= 0) return {};
  const hdf5::Handle group = hdf5::open_group(file, "breaks");
  return TableOf<decltype(record::break_fields)>::read(group, record::break_fields);
}

void TextColumn::append(std::string_view text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  bytes_.append(bytes);
}

void TextColumn::append_line(const std::string& line) {
  append(line + '\n');
}

std::string TextColumn::read(hid_t file, const std::string& name) {
  const auto bytes = read_column<std::uint8_t>(file, name);
  return {bytes.values.begin(), std::find(bytes.values.begin(), bytes.values.end(), std::uint8_t{0})};
}

std::vector<std::string> TextColumn::read_lines(hid_t file, const std::string& name) {
  const std::string text = read(file, name);
  std::vector<std::string> lines;
  for (auto begin = text.begin();;) {
    const auto end = std::find(begin, text.end(), '\n');
    if (end == text.end()) return lines;
    lines.emplace_back(begin, end);
    begin = end + 1;
  }
}

}  // namespace keyblock::results
