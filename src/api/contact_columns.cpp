#include "api/contact_columns.h"

#include "api/edge_names.h"

namespace keyblock::api {

Contacts contact_columns(const simulation::ContactFrame& frame, const simulation::ModelRecord& model) {
  Contacts contacts;
  const EdgeNames names{model.joint_set_names, model.trace_map_names, model.excavation_names};
  contacts.joint_names = names.all();
  const std::size_t count = frame.contacts.size();
  for (auto* column : {&contacts.block_a, &contacts.block_b, &contacts.joint}) column->reserve(count);
  for (auto* column : {&contacts.position, &contacts.normal}) column->reserve(2 * count);
  for (auto* column : {&contacts.length, &contacts.gap, &contacts.slip, &contacts.shear_displacement,
                       &contacts.normal_force, &contacts.shear_force})
    column->reserve(count);
  contacts.state.reserve(count);
  for (const simulation::ContactRecord& c : frame.contacts) {
    contacts.block_a.push_back(c.block_a);
    contacts.block_b.push_back(c.block_b);
    contacts.state.push_back(static_cast<std::uint8_t>(c.state));
    contacts.position.insert(contacts.position.end(), {c.position.x, c.position.y});
    contacts.normal.insert(contacts.normal.end(), {c.normal.x, c.normal.y});
    contacts.length.push_back(c.length);
    contacts.gap.push_back(c.gap);
    contacts.slip.push_back(c.slip());
    contacts.shear_displacement.push_back(c.shear_displacement);
    contacts.normal_force.push_back(c.normal_force);
    contacts.shear_force.push_back(c.shear_force);
    contacts.joint.push_back(names.code_of(c.label));
  }
  return contacts;
}

}  // namespace keyblock::api
