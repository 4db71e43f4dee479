#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "array_of.h"
#include "bindings.h"
#include "stepped.h"

namespace py = pybind11;

namespace keyblock::python {
namespace {

using Integers = py::array_t<std::int32_t, py::array::c_style>;
using Numbers = py::array_t<double, py::array::c_style>;

struct NamedColumn {
  std::string_view name;
  ContactColumn column;
  std::function<py::array(Contacts&)> array;
};

template <auto Column, std::size_t columns = 1>
py::array array_from(Contacts& contacts) {
  return array_of(std::move(contacts.*Column), columns);
}

const std::vector<NamedColumn>& all_columns() {
  static const std::vector<NamedColumn> all = [] {
    std::vector<NamedColumn> made{
        {"block_a", ContactColumn::block_a, &array_from<&Contacts::block_a>},
        {"block_b", ContactColumn::block_b, &array_from<&Contacts::block_b>},
        {"vertex", ContactColumn::vertex, &array_from<&Contacts::vertex>},
        {"edge", ContactColumn::edge, &array_from<&Contacts::edge>},
        {"state", ContactColumn::state, &array_from<&Contacts::state>},
        {"position", ContactColumn::position, &array_from<&Contacts::position, 2>},
        {"normal", ContactColumn::normal, &array_from<&Contacts::normal, 2>},
        {"joint_code", ContactColumn::joint, &array_from<&Contacts::joint>},
    };
    for (const ContactNumbers& numbers : contact_numbers)
      made.push_back({numbers.name, numbers.column, [list = numbers.list](Contacts& contacts) -> py::array {
                        return array_of(std::move(contacts.*list), 1);
                      }});
    return made;
  }();
  return all;
}

/// In one pass over the contacts.
py::list contact_columns(const Stepped& stepped, const std::vector<std::string>& names) {
  std::vector<const NamedColumn*> wanted;
  std::vector<ContactColumn> asked;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all_columns(), name, &NamedColumn::name);
    if (found == all_columns().end()) throw py::key_error(name);
    wanted.push_back(&*found);
    asked.push_back(found->column);
  }
  Contacts contacts = stepped.at_rest().contacts(asked);
  py::list arrays;
  for (const NamedColumn* column : wanted) arrays.append(column->array(contacts));
  return arrays;
}

/// Contacts by their vertices and edges, with a strength for each, or none.
std::vector<ContactStrength> strengths_of(const Integers& vertices, const Integers& edges,
                                          const std::optional<Numbers>& friction,
                                          const std::optional<Numbers>& cohesion,
                                          const std::optional<Numbers>& tension) {
  const py::ssize_t count = vertices.size();
  const auto check = [&](const py::array& array) {
    if (array.ndim() != 1 || array.size() != count)
      throw py::value_error("a number for each contact is needed: " + std::to_string(count));
  };
  check(vertices);
  check(edges);
  for (const auto* given : {&friction, &cohesion, &tension})
    if (*given) check(**given);
  const auto value = [](const std::optional<Numbers>& of, py::ssize_t k) {
    return of ? std::optional(of->data()[k]) : std::nullopt;
  };
  std::vector<ContactStrength> strengths;
  strengths.reserve(static_cast<std::size_t>(count));
  for (py::ssize_t k = 0; k < count; ++k)
    strengths.push_back(
        {vertices.data()[k], edges.data()[k], value(friction, k), value(cohesion, k), value(tension, k)});
  return strengths;
}

py::list list_of(const std::vector<ContactStrength>& strengths) {
  py::list list;
  for (const ContactStrength& s : strengths)
    list.append(py::make_tuple(s.vertex, s.edge, s.friction, s.cohesion, s.tension));
  return list;
}

}  // namespace

void bind_contacts(py::class_<Stepped, std::shared_ptr<Stepped>>& simulation) {
  simulation
      .def_property_readonly("contact_count", [](const Stepped& s) { return s.at_rest().contact_count(); })
      .def_property_readonly("joint_names",
                             [](const Stepped& s) { return s.at_rest().contacts({}).joint_names; })
      .def("contact_columns", &contact_columns, py::arg("names"))
      .def_property_readonly("contact_strengths",
                             [](const Stepped& s) { return list_of(s.at_rest().contact_strengths()); })
      .def(
          "set_contact_strengths",
          [](Stepped& s, const Integers& vertices, const Integers& edges,
             const std::optional<Numbers>& friction, const std::optional<Numbers>& cohesion,
             const std::optional<Numbers>& tension) {
            s.at_rest().set_contact_strengths(strengths_of(vertices, edges, friction, cohesion, tension));
          },
          py::arg("vertices"), py::arg("edges"), py::arg("friction"), py::arg("cohesion"), py::arg("tension"))
      .def("forget_contact_strengths", [](Stepped& s, const Integers& vertices, const Integers& edges) {
        s.at_rest().forget_contact_strengths(strengths_of(vertices, edges, {}, {}, {}));
      });
}

}  // namespace keyblock::python
