#include <algorithm>
#include <utility>

#include "record/contact_fields.h"
#include "results/result_tables.h"
#include "results/table_rows.h"

namespace keyblock::results {
namespace {

using hdf5::read_array;
using hdf5::read_column;
using record::contact_fields;
using record::ContactField;
using record::ContactRecord;

/// The columns of numbers of contacts that a file has, one for each number: that with the sign, where there are two.
class Numbers {
 public:
  explicit Numbers(hid_t group) {
    for (const ContactField& field : contact_fields) {
      const bool is_there = H5Lexists(group, field.name, H5P_DEFAULT) > 0;
      if ((!is_there && field.is_late) || ((!is_there || field.is_magnitude) && has_other(group, field)))
        continue;
      columns_.emplace_back(&field, read_column<double>(group, field.name));
    }
  }
  /// That all columns have.
  [[nodiscard]] std::size_t rows() const {
    std::size_t rows = columns_.front().second.rows();
    for (const auto& [field, column] : columns_) rows = std::min(rows, column.rows());
    return rows;
  }
  void put(std::size_t row, ContactRecord& contact) const {
    for (const auto& [field, column] : columns_) contact.*field->number = column.values[row];
  }

 private:
  /// Whether the file has the number by another column.
  static bool has_other(hid_t group, const ContactField& field) {
    return std::ranges::any_of(contact_fields, [&](const ContactField& other) {
      return other.number == field.number && &other != &field &&
             H5Lexists(group, other.name, H5P_DEFAULT) > 0;
    });
  }
  std::vector<std::pair<const ContactField*, hdf5::Array<double>>> columns_;
};

}  // namespace

ContactTable::ContactTable(hid_t file)
    : group_(hdf5::create_group(file, "contacts")),
      block_a_(group_, "block_a", {}),
      block_b_(group_, "block_b", {}),
      state_(group_, "state", {}),
      edge_kind_(group_, "edge_kind", {}),
      edge_index_(group_, "edge_index", {}),
      position_(group_, "position", {2}),
      normal_(group_, "normal", {2}),
      stage_(group_, "stage", {}),
      step_(group_, "step", {}),
      end_(group_, "end", {}),
      contact_(group_, "contact", {}),
      time_(group_, "time", {}) {
  for (const ContactField& field : contact_fields)
    numbers_.emplace_back(group_, field.name, std::vector<hsize_t>{});
}

void ContactTable::append(const record::ContactFrame& frame) {
  for (const ContactRecord& c : frame.contacts) {
    contact_.append(static_cast<std::int64_t>(contact_.rows()));
    block_a_.append(c.block_a);
    block_b_.append(c.block_b);
    state_.append(static_cast<std::uint8_t>(c.state));
    edge_kind_.append(static_cast<std::uint8_t>(c.label.kind));
    edge_index_.append(c.label.index);
    position_.append(flat(&c.position.x, 2));
    normal_.append(flat(&c.normal.x, 2));
    for (std::size_t k = 0; k < numbers_.size(); ++k) numbers_[k].append(contact_fields[k].of(c));
  }
  stage_.append(frame.stage);
  step_.append(frame.step);
  end_.append(static_cast<std::int64_t>(contact_.rows()));
  time_.append(frame.time);
}

void ContactTable::flush() {
  for (auto* column : {&block_a_, &block_b_, &stage_}) column->flush();
  for (auto* column : {&state_, &edge_kind_}) column->flush();
  edge_index_.flush();
  for (auto* column : {&position_, &normal_}) column->flush();
  for (auto& column : numbers_) column.flush();
  for (auto* column : {&step_, &end_, &contact_}) column->flush();
  time_.flush();
}

std::vector<record::ContactFrame> ContactTable::read(hid_t file) {
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
  const Numbers numbers(group);
  require(position.width() == 2, "contacts/position");
  require(normal.width() == 2, "contacts/normal");
  const std::size_t rows = std::min({block_a.rows(), block_b.rows(), state.rows(), edge_kind.rows(),
                                     edge_index.rows(), position.rows(), normal.rows(), numbers.rows()});
  std::vector<record::ContactFrame> frames;
  std::size_t k = 0;
  for (std::size_t f = 0; f < common_rows(time, {stage.rows(), step.rows(), end.rows()}); ++f) {
    const auto last = static_cast<std::size_t>(end.values[f]);
    if (last > rows) break;
    record::ContactFrame frame{time.values[f], stage.values[f], {}, step.values[f]};
    for (; k < last; ++k) {
      ContactRecord& c = frame.contacts.emplace_back();
      c.block_a = block_a.values[k];
      c.block_b = block_b.values[k];
      c.state = enumerator(state.values[k], record::ContactState::locked, "contacts/state");
      c.position = {position.values[2 * k], position.values[2 * k + 1]};
      c.normal = {normal.values[2 * k], normal.values[2 * k + 1]};
      c.label = {enumerator(edge_kind.values[k], cutting::EdgeKind::domain, "contacts/edge_kind"),
                 edge_index.values[k]};
      numbers.put(k, c);
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace keyblock::results
