#include "keyblock/scenario.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.h"

namespace py = pybind11;

namespace keyblock::python {

void bind_scenario(py::module_& module) {
  const auto free = py::call_guard<py::gil_scoped_release>();
  py::class_<Block> block(module, "Block", py::is_final(), "A block as it is cut, before anything moves.");
  block.def_readonly("rings", &Block::rings, "m: the outer ring, counter-clockwise, then holes.")
      .def_readonly("edges", &Block::edges, "Of each ring, what each edge is a piece of.")
      .def_readonly("name", &Block::name)
      .def_readonly("excavations", &Block::excavations)
      .def_readonly("area", &Block::area, "m2");
  seal(block);
  // Functions take references: a method by its address would take None for the object, and use it.
  py::class_<Scenario> scenario(module, "Scenario", py::is_final());
  scenario.def_static("empty", [] { return Scenario(); })
      .def("copy", [](const Scenario& s) { return s; })
      .def_static("load", &Scenario::load, py::arg("file"))
      .def_static("parse", &Scenario::parse, py::arg("text"), py::arg("file") = "scenario.toml")
      .def(
          "set", [](Scenario& s, const std::string& key, const std::string& toml) { s.set(key, toml); },
          py::arg("key"), py::arg("toml"))
      .def(
          "append", [](Scenario& s, const std::string& key, const std::string& toml) { s.append(key, toml); },
          py::arg("key"), py::arg("toml"))
      .def(
          "json", [](const Scenario& s, const std::string& key) { return s.json(key); }, py::arg("key") = "")
      .def("toml", [](const Scenario& s) { return s.toml(); })
      .def_property_readonly("text", [](const Scenario& s) { return s.text(); })
      .def_property_readonly("file", [](const Scenario& s) { return s.file(); })
      .def_property_readonly("changes", [](const Scenario& s) { return s.changes(); })
      .def_property_readonly("is_made", [](const Scenario& s) { return s.is_made(); })
      .def(
          "check", [](const Scenario& s, int realization) { return s.check(realization); },
          py::arg("realization") = 0, free)
      .def(
          "cut", [](const Scenario& s, int realization) { return s.cut(realization); },
          py::arg("realization") = 0, free);
  seal(scenario);
}

}  // namespace keyblock::python
