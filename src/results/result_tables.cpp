#include "results/result_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "core/error.h"
#include "results/record_fields.h"
#include "results/table_rows.h"

namespace keyblock::results {
namespace {

using hdf5::Array;
using hdf5::read_array;
using hdf5::read_column;

constexpr std::size_t energy_terms = std::size(energy_fields);
constexpr std::size_t first_energy_terms = 9;  // of results of the first version

static_assert(sizeof(Vec2) == 2 * sizeof(double));

// The value as one of an enumeration that ends with `last`.
template <class Enum>
Enum enumerator(std::uint8_t value, Enum last, const char* what) {
  if (value > static_cast<std::uint8_t>(last))
    throw RunError(fmt::format("{} holds the unknown value {}", what, value));
  return static_cast<Enum>(value);
}

}  // namespace

FrameTable::FrameTable(hid_t file, const simulation::ModelRecord& model)
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

void FrameTable::append(const simulation::Frame& frame) {
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
  for (const simulation::BlockStatus s : frame.status) status.push_back(static_cast<std::uint8_t>(s));
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

std::vector<simulation::Frame> FrameTable::read(hid_t file, const simulation::ModelRecord& model) {
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
  std::vector<simulation::Frame> frames(
      common_rows(time, {displacement.rows(), stress.rows(), status.rows(), order.rows(), stage.rows(),
                         step.rows(), has_velocity ? velocity.rows() : displacement.rows()}));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    simulation::Frame& frame = frames[f];
    frame.time = time.values[f];
    frame.stage = stage.values[f];
    frame.step = step.values[f];
    frame.displacement.resize(nv);
    frame.stress.resize(nb);
    std::copy_n(displacement.values.data() + 2 * nv * f, 2 * nv, frame.displacement.data()->data());
    std::copy_n(stress.values.data() + 3 * nb * f, 3 * nb, frame.stress.data()->data());
    if (has_velocity) {
      frame.velocity.resize(nb);
      std::copy_n(velocity.values.data() + 2 * nb * f, 2 * nb, frame.velocity.data()->data());
    }
    const auto orders = std::span(order.values).subspan(nb * f, nb);
    frame.order.assign(orders.begin(), orders.end());
    for (std::size_t b = 0; b < nb; ++b) {
      frame.status.push_back(
          enumerator(status.values[nb * f + b], simulation::BlockStatus::excavated, "frames/status"));
    }
  }
  ElementTable::read(file, model.elements.size(), frames);
  return frames;
}

ContactTable::ContactTable(hid_t file)
    : group_(hdf5::create_group(file, "contacts")),
      block_a_(group_, "block_a", {}),
      block_b_(group_, "block_b", {}),
      state_(group_, "state", {}),
      edge_kind_(group_, "edge_kind", {}),
      edge_index_(group_, "edge_index", {}),
      position_(group_, "position", {2}),
      normal_(group_, "normal", {2}),
      length_(group_, "length", {}),
      gap_(group_, "gap", {}),
      slip_(group_, "slip", {}),
      shear_displacement_(group_, "shear_displacement", {}),
      normal_force_(group_, "normal_force", {}),
      shear_force_(group_, "shear_force", {}),
      water_pressure_(group_, "water_pressure", {}),
      stage_(group_, "stage", {}),
      step_(group_, "step", {}),
      end_(group_, "end", {}),
      contact_(group_, "contact", {}),
      time_(group_, "time", {}) {}

void ContactTable::append(const simulation::ContactFrame& frame) {
  for (const simulation::ContactRecord& c : frame.contacts) {
    contact_.append(static_cast<std::int64_t>(contact_.rows()));
    block_a_.append(c.block_a);
    block_b_.append(c.block_b);
    state_.append(static_cast<std::uint8_t>(c.state));
    edge_kind_.append(static_cast<std::uint8_t>(c.label.kind));
    edge_index_.append(c.label.index);
    position_.append(flat(&c.position.x, 2));
    normal_.append(flat(&c.normal.x, 2));
    length_.append(c.length);
    gap_.append(c.gap);
    slip_.append(c.slip());
    shear_displacement_.append(c.shear_displacement);
    normal_force_.append(c.normal_force);
    shear_force_.append(c.shear_force);
    water_pressure_.append(c.water_pressure);
  }
  stage_.append(frame.stage);
  step_.append(frame.step);
  end_.append(static_cast<std::int64_t>(gap_.rows()));
  time_.append(frame.time);
}

void ContactTable::flush() {
  for (auto* column : {&block_a_, &block_b_, &stage_}) column->flush();
  for (auto* column : {&state_, &edge_kind_}) column->flush();
  edge_index_.flush();
  for (auto* column : {&position_, &normal_, &length_, &gap_, &slip_, &shear_displacement_, &normal_force_,
                       &shear_force_, &water_pressure_})
    column->flush();
  for (auto* column : {&step_, &end_, &contact_}) column->flush();
  time_.flush();
}

std::vector<simulation::ContactFrame> ContactTable::read(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "contacts");
  const auto time = read_column<double>(group, "time");
  const auto stage = read_column<std::int32_t>(group, "stage");
  const auto step = read_column<std::int64_t>(group, "step"), end = read_column<std::int64_t>(group, "end");
  const auto block_a = read_column<std::int32_t>(group, "block_a"),
             block_b = read_column<std::int32_t>(group, "block_b");
  const auto state = read_column<std::uint8_t>(group, "state"),
             edge_kind = read_column<std::uint8_t>(group, "edge_kind");
  const auto edge_index = read_column<std::int16_t>(group, "edge_index");
  const auto position = read_array<double>(group, "position"), normal = read_array<double>(group, "normal");
  const auto length = read_column<double>(group, "length"), gap = read_column<double>(group, "gap");
  // Earlier files have it under the name of its magnitude.
  const char* const signed_slip =
      H5Lexists(group, "shear_displacement", H5P_DEFAULT) > 0 ? "shear_displacement" : "slip";
  const auto slip = read_column<double>(group, signed_slip),
             normal_force = read_column<double>(group, "normal_force");
  const auto shear_force = read_column<double>(group, "shear_force");
  // Results of earlier versions do not have it.
  const bool has_water = H5Lexists(group, "water_pressure", H5P_DEFAULT) > 0;
  const auto water_pressure = has_water
                                  ? read_column<double>(group, "water_pressure")
                                  : hdf5::Array<double>{gap.shape, std::vector<double>(gap.rows(), 0.0)};
  require(position.width() == 2, "contacts/position");
  require(normal.width() == 2, "contacts/normal");
  const std::size_t rows =
      std::min({block_a.rows(), block_b.rows(), state.rows(), edge_kind.rows(), edge_index.rows(),
                position.rows(), normal.rows(), length.rows(), gap.rows(), slip.rows(), normal_force.rows(),
                shear_force.rows(), water_pressure.rows()});
  std::vector<simulation::ContactFrame> frames;
  std::size_t k = 0;
  for (std::size_t f = 0; f < common_rows(time, {stage.rows(), step.rows(), end.rows()}); ++f) {
    const auto last = static_cast<std::size_t>(end.values[f]);
    if (last > rows) break;
    simulation::ContactFrame frame{time.values[f], stage.values[f], {}, step.values[f]};
    for (; k < last; ++k) {
      frame.contacts.push_back(
          {block_a.values[k],
           block_b.values[k],
           enumerator(state.values[k], simulation::ContactState::locked, "contacts/state"),
           {position.values[2 * k], position.values[2 * k + 1]},
           {normal.values[2 * k], normal.values[2 * k + 1]},
           length.values[k],
           gap.values[k],
           slip.values[k],
           normal_force.values[k],
           shear_force.values[k],
           {enumerator(edge_kind.values[k], cutting::EdgeKind::domain, "contacts/edge_kind"),
            edge_index.values[k]},
           water_pressure.values[k]});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

StepTable::StepTable(hid_t file)
    : group_(hdf5::create_group(file, "steps")),
      stage_(group_, "stage", {}),
      iterations_(group_, "iterations", {}),
      closed_contacts_(group_, "closed_contacts", {}),
      step_(group_, "step", {}),
      step_size_(group_, "step_size", {}),
      penetration_(group_, "penetration", {}),
      max_displacement_(group_, "max_displacement", {}),
      energy_(group_, "energy", {energy_terms}),
      time_(group_, "time", {}) {
  std::vector<std::string> names;
  for (const auto& [name, member] : energy_fields) names.emplace_back(name);
  hdf5::write_strings(group_, "energy_names", names);
}

void StepTable::append(const simulation::StepRow& row) {
  std::array<double, energy_terms> energy{};
  for (std::size_t k = 0; k < energy_terms; ++k) energy[k] = row.energy.*energy_fields[k].second;
  stage_.append(row.stage);
  iterations_.append(row.iterations);
  closed_contacts_.append(row.closed_contacts);
  step_.append(row.step);
  step_size_.append(row.step_size);
  penetration_.append(row.penetration);
  max_displacement_.append(row.max_displacement);
  energy_.append(energy);
  time_.append(row.time);
}

void StepTable::flush() {
  for (auto* column : {&stage_, &iterations_, &closed_contacts_}) column->flush();
  step_.flush();
  for (auto* column : {&step_size_, &penetration_, &max_displacement_, &energy_}) column->flush();
  time_.flush();
}

std::vector<simulation::StepRow> StepTable::read(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "steps");
  const auto time = read_column<double>(group, "time");
  const auto stage = read_column<std::int32_t>(group, "stage"),
             iterations = read_column<std::int32_t>(group, "iterations");
  const auto closed_contacts = read_column<std::int32_t>(group, "closed_contacts");
  const auto step = read_column<std::int64_t>(group, "step");
  const auto step_size = read_column<double>(group, "step_size"),
             penetration = read_column<double>(group, "penetration");
  const auto max_displacement = read_column<double>(group, "max_displacement");
  const auto energy = read_array<double>(group, "energy");
  const std::size_t terms = energy.width();
  require(terms >= first_energy_terms && terms <= energy_terms, "steps/energy");
  std::vector<simulation::StepRow> rows(
      common_rows(time, {stage.rows(), iterations.rows(), closed_contacts.rows(), step.rows(),
                         step_size.rows(), penetration.rows(), max_displacement.rows(), energy.rows()}));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k] = {time.values[k],
               step.values[k],
               stage.values[k],
               iterations.values[k],
               step_size.values[k],
               penetration.values[k],
               max_displacement.values[k],
               closed_contacts.values[k],
               {}};
    for (std::size_t i = 0; i < terms; ++i) {
      rows[k].energy.*energy_fields[i].second = energy.values[terms * k + i];
    }
  }
  return rows;
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
