#include "api/contact_columns.h"

#include <stdexcept>

namespace keyblock::api {

ContactColumns::ContactColumns(const simulation::ModelRecord& model, std::size_t count)
    : names_{model.joint_set_names, model.trace_map_names, model.excavation_names} {
  contacts_.joint_names = names_.all();
  for (auto* column : {&contacts_.block_a, &contacts_.block_b, &contacts_.joint}) column->resize(count);
  for (auto* column : {&contacts_.position, &contacts_.normal}) column->resize(2 * count);
  for (auto* column : {&contacts_.length, &contacts_.gap, &contacts_.slip, &contacts_.shear_displacement,
                       &contacts_.normal_force, &contacts_.shear_force})
    column->resize(count);
  contacts_.state.resize(count);
}

void ContactColumns::add(std::span<const simulation::ContactRecord> some) {
  if (count_ + some.size() > contacts_.state.size()) throw std::out_of_range("more contacts than announced");
  // A column at a time, so that each is written in one go.
  const auto fill = [&](auto& column, const auto& value) {
    auto* to = column.data() + count_;
    for (const simulation::ContactRecord& c : some) *to++ = value(c);
  };
  const auto fill_points = [&](std::vector<double>& column, Vec2 simulation::ContactRecord::*value) {
    double* to = column.data() + 2 * count_;
    for (const simulation::ContactRecord& c : some) {
      *to++ = (c.*value).x;
      *to++ = (c.*value).y;
    }
  };
  using Record = simulation::ContactRecord;
  fill(contacts_.block_a, [](const Record& c) { return c.block_a; });
  fill(contacts_.block_b, [](const Record& c) { return c.block_b; });
  fill(contacts_.state, [](const Record& c) { return static_cast<std::uint8_t>(c.state); });
  fill_points(contacts_.position, &Record::position);
  fill_points(contacts_.normal, &Record::normal);
  fill(contacts_.length, [](const Record& c) { return c.length; });
  fill(contacts_.gap, [](const Record& c) { return c.gap; });
  fill(contacts_.slip, [](const Record& c) { return c.slip(); });
  fill(contacts_.shear_displacement, [](const Record& c) { return c.shear_displacement; });
  fill(contacts_.normal_force, [](const Record& c) { return c.normal_force; });
  fill(contacts_.shear_force, [](const Record& c) { return c.shear_force; });
  fill(contacts_.joint, [&](const Record& c) { return names_.code_of(c.label); });
  count_ += some.size();
}

}  // namespace keyblock::api
