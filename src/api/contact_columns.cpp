#include "api/contact_columns.h"

#include <stdexcept>
#include <string_view>

#include "record/contact_fields.h"

namespace keyblock::api {

using Record = record::ContactRecord;

namespace {

/// A list, and what of a record goes into it.
struct Filled {
  ContactNumbers list;
  const record::ContactField* from;
};

/// The lists of what results keep, too.
const std::vector<Filled>& filled_lists() {
  static const std::vector<Filled> all = [] {
    std::vector<Filled> found;
    for (const ContactNumbers& list : contact_numbers)
      for (const record::ContactField& field : record::contact_fields)
        if (std::string_view(list.name) == field.name) found.push_back({list, &field});
    return found;
  }();
  return all;
}

}  // namespace

std::vector<ContactColumn> all_contact_columns() {
  std::vector<ContactColumn> all;
  for (std::size_t k = 0; k < column_count; ++k) all.push_back(static_cast<ContactColumn>(k));
  return all;
}

std::vector<ContactColumn> kept_contact_columns() {
  std::vector<ContactColumn> kept = all_contact_columns();
  using enum ContactColumn;
  std::erase_if(kept, [](ContactColumn column) {
    return column == vertex || column == edge || column == friction || column == cohesion ||
           column == tension;
  });
  return kept;
}

ContactColumns::ContactColumns(const record::ModelRecord& model, std::size_t count,
                               std::span<const ContactColumn> wanted)
    : names_{model.joint_set_names, model.trace_map_names, model.excavation_names}, of_all_(count) {
  contacts_.joint_names = names_.all();
  for (const ContactColumn column : wanted) wanted_.set(static_cast<std::size_t>(column));
}

record::ContactParts ContactColumns::parts() const {
  using enum ContactColumn;
  const auto wants_any = [&](const auto&... columns) { return (wants(columns) || ...); };
  record::ContactParts parts{.places = wants_any(block_a, block_b, vertex, edge, position, normal, joint),
                             .slips = false,
                             .forces = wants_any(state),
                             .strengths = wants_any(friction, cohesion, tension)};
  for (const Filled& filled : filled_lists())
    if (wants(filled.list.column)) parts.*filled.from->part = true;
  return parts;
}

// A column at a time, so that each is written in one go.
template <typename Number, typename Value>
void ContactColumns::fill(ContactColumn column, std::vector<Number>& to, Records some, const Value& value) {
  if (!wants(column)) return;
  to.resize(of_all_);
  Number* at = to.data() + count_;
  for (const Record& record : some) *at++ = static_cast<Number>(value(record));
}

void ContactColumns::fill_points(ContactColumn column, std::vector<double>& to, Records some,
                                 Vec2 Record::*value) {
  if (!wants(column)) return;
  to.resize(2 * of_all_);
  double* at = to.data() + 2 * count_;
  for (const Record& record : some) {
    *at++ = (record.*value).x;
    *at++ = (record.*value).y;
  }
}

void ContactColumns::add(Records some) {
  if (count_ + some.size() > of_all_) throw std::out_of_range("more contacts than announced");
  add_places(some);
  add_mechanics(some);
  count_ += some.size();
}

void ContactColumns::add_places(Records some) {
  const auto of = [](auto Record::*value) { return [value](const Record& record) { return record.*value; }; };
  Contacts& c = contacts_;
  fill(ContactColumn::block_a, c.block_a, some, of(&Record::block_a));
  fill(ContactColumn::block_b, c.block_b, some, of(&Record::block_b));
  fill(ContactColumn::vertex, c.vertex, some, of(&Record::vertex));
  fill(ContactColumn::edge, c.edge, some, of(&Record::edge));
  fill_points(ContactColumn::position, c.position, some, &Record::position);
  fill_points(ContactColumn::normal, c.normal, some, &Record::normal);
  fill(ContactColumn::joint, c.joint, some,
       [&](const Record& record) { return names_.code_of(record.label); });
}

void ContactColumns::add_mechanics(Records some) {
  const auto of = [](auto Record::*value) { return [value](const Record& record) { return record.*value; }; };
  Contacts& c = contacts_;
  fill(ContactColumn::state, c.state, some, of(&Record::state));
  for (const Filled& filled : filled_lists())
    fill(filled.list.column, c.*filled.list.list, some,
         [&](const Record& record) { return filled.from->of(record); });
  // Most contacts are of few joints.
  double coefficient = 0.0, degrees = 0.0;
  fill(ContactColumn::friction, c.friction, some, [&](const Record& record) {
    if (record.friction != coefficient) degrees = degrees_of(coefficient = record.friction);
    return degrees;
  });
  fill(ContactColumn::cohesion, c.cohesion, some, of(&Record::cohesion));
  fill(ContactColumn::tension, c.tension, some, of(&Record::tension));
}

}  // namespace keyblock::api
