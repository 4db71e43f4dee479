#pragma once
#include <bitset>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "api/edge_names.h"
#include "keyblock/simulation.h"
#include "record/record.h"

namespace keyblock::api {

/// Of a coefficient of friction.
inline double degrees_of(double coefficient) {
  return std::atan(coefficient) * 180.0 / std::numbers::pi;
}

/// Of them all.
inline constexpr std::size_t column_count = static_cast<std::size_t>(ContactColumn::joint) + 1;

std::vector<ContactColumn> all_contact_columns();
/// Those that results keep.
std::vector<ContactColumn> kept_contact_columns();

/// Makes columns of contacts that come some at a time.
class ContactColumns {
 public:
  ContactColumns(const record::ModelRecord& model, std::size_t count, std::span<const ContactColumn> wanted);

  /// What the records need to have for these columns.
  [[nodiscard]] record::ContactParts parts() const;
  /// Throws std::out_of_range beyond `count` contacts.
  void add(std::span<const record::ContactRecord> some);
  /// All of them; at the end.
  [[nodiscard]] Contacts take() { return std::move(contacts_); }

 private:
  using Records = std::span<const record::ContactRecord>;
  [[nodiscard]] bool wants(ContactColumn column) const { return wanted_[static_cast<std::size_t>(column)]; }
  /// value(record) of each, where the column is wanted.
  template <typename Number, typename Value>
  void fill(ContactColumn column, std::vector<Number>& to, Records some, const Value& value);
  void fill_points(ContactColumn column, std::vector<double>& to, Records some,
                   Vec2 record::ContactRecord::*value);
  void add_places(Records some);
  void add_mechanics(Records some);

  EdgeNames names_;
  std::bitset<column_count> wanted_;
  Contacts contacts_;
  std::size_t count_ = 0;   ///< so far
  std::size_t of_all_ = 0;  ///< announced
};

}  // namespace keyblock::api
