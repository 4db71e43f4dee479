#include "keyblock/scenario.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.h"
#include "values.h"

namespace py = pybind11;

namespace keyblock::python {

namespace {

py::object object_or_none(const std::optional<Value>& value) {
  return value ? object_of(*value) : py::none();
}

Scenario made(const py::dict& values, const std::filesystem::path& file) {
  Scenario scenario = Scenario::empty(file);
  for (const auto& [key, value] : values) scenario.set(py::cast<std::string>(key), value_of(value));
  return scenario;
}

/// Other threads of Python may change a scenario meanwhile: the work is done on a copy, which lives longer than the lock is given back.
template <class Work>
auto without_lock(const Scenario& scenario, const Work& work) {
  const Scenario own = scenario;
  const py::gil_scoped_release free;
  return work(own);
}

/// What a scenario comes to: blocks and key blocks; and what is known of keys.
void bind_parts(py::module_& module) {
  py::class_<Block> block(module, "Block", py::is_final(), "A block as it is cut, before anything moves.");
  block.def_readonly("rings", &Block::rings, "m: the outer ring, counter-clockwise, then holes.")
      .def_readonly("edges", &Block::edges, "Of each ring, what each edge is a piece of.")
      .def_readonly("name", &Block::name)
      .def_readonly("excavations", &Block::excavations)
      .def_readonly("area", &Block::area, "m2");
  seal(block);
  py::class_<KeyBlock> key_block(module, "KeyBlock", py::is_final(), "A block with a face on an opening.");
  key_block.def_readonly("block", &KeyBlock::block)
      .def_readonly("name", &KeyBlock::name)
      .def_readonly("layer", &KeyBlock::layer)
      .def_readonly("centroid", &KeyBlock::centroid)
      .def_readonly("area", &KeyBlock::area)
      .def_readonly("depth", &KeyBlock::depth)
      .def_readonly("weight", &KeyBlock::weight)
      .def_readonly("mode", &KeyBlock::mode)
      .def_readonly("factor_of_safety", &KeyBlock::factor_of_safety)
      .def_readonly("force", &KeyBlock::force)
      .def_readonly("direction", &KeyBlock::direction)
      .def_readonly("joints", &KeyBlock::joints);
  seal(key_block);
  py::class_<Census> census(module, "Census", py::is_final(), "The key blocks of one realization.");
  census.def_readonly("blocks", &Census::blocks)
      .def_readonly("layers", &Census::layers)
      .def_readonly("wall", &Census::wall)
      .def_readonly("wanted_factor", &Census::wanted_factor)
      .def_readonly("assumptions", &Census::assumptions);
  seal(census);
  py::class_<KeyMeaning> meaning(module, "KeyMeaning", py::is_final(),
                                 "What docs/scenario.md says of a key.");
  meaning.def_readonly("key", &KeyMeaning::key)
      .def_readonly("meaning", &KeyMeaning::meaning)
      .def_readonly("type", &KeyMeaning::type)
      .def_property_readonly("standard", [](const KeyMeaning& m) { return object_or_none(m.standard); })
      .def_readonly("standard_text", &KeyMeaning::standard_text);
  seal(meaning);
}

/// Values by their keys.
void bind_keys(py::class_<Scenario>& scenario) {
  scenario
      .def(
          "set",
          [](Scenario& s, const std::string& key, const py::object& value) {
            const Value known = value_of(value);
            Scenario::check_keys(key, known);
            s.set(key, known);
          },
          py::arg("key"), py::arg("value"))
      .def(
          "restore",
          [](Scenario& s, const std::string& key, const py::object& value) { s.set(key, value_of(value)); },
          py::arg("key"), py::arg("value"), "What a scenario had set, known or not.")
      .def(
          "set_toml", [](Scenario& s, const std::string& key, const std::string& toml) { s.set(key, toml); },
          py::arg("key"), py::arg("toml"))
      .def(
          "append",
          [](Scenario& s, const std::string& key, const py::object& value) {
            const Value known = value_of(value);
            Scenario::check_keys(key, known);
            s.append(key, known);
          },
          py::arg("key"), py::arg("value"))
      .def(
          "extend",
          [](Scenario& s, const std::string& key, const py::iterable& values) {
            Value list = Value::List();
            for (const py::handle& value : values) std::get<Value::List>(list.is).push_back(value_of(value));
            Scenario::check_keys(key, list);
            s.extend(key, std::get<Value::List>(list.is));
          },
          py::arg("key"), py::arg("values"))
      .def(
          "remove", [](Scenario& s, const std::string& key) { s.remove(key); }, py::arg("key"))
      .def(
          "has", [](const Scenario& s, const std::string& key) { return s.has(key); }, py::arg("key"))
      .def(
          "value", [](const Scenario& s, const std::string& key) { return object_or_none(s.value(key)); },
          py::arg("key") = "")
      .def(
          "keys", [](const Scenario& s, const std::string& key) { return s.keys(key); }, py::arg("key") = "")
      .def(
          "is_table", [](const Scenario& s, const std::string& key) { return s.is_table(key); },
          py::arg("key"))
      .def(
          "is_list_of_tables",
          [](const Scenario& s, const std::string& key) { return s.is_list_of_tables(key); }, py::arg("key"))
      .def_static(
          "check_keys", [](const std::string& key) { Scenario::check_keys(key); }, py::arg("key"))
      .def_static("known_keys", &Scenario::known_keys, py::arg("table") = "");
}

}  // namespace

void bind_scenario(py::module_& module) {
  bind_parts(module);
  // Functions take references: a method by its address would take None for the object, and use it.
  py::class_<Scenario> scenario(module, "Scenario", py::is_final());
  scenario.def_static("empty", [] { return Scenario(); })
      .def("copy", [](const Scenario& s) { return s; })
      .def_static("load", &Scenario::load, py::arg("file"))
      .def_static("parse", &Scenario::parse, py::arg("text"), py::arg("file") = "scenario.toml")
      .def_static("made", &made, py::arg("values"), py::arg("file"));
  bind_keys(scenario);
  scenario.def("toml", [](const Scenario& s) { return s.toml(); })
      .def_property_readonly("text", [](const Scenario& s) { return s.text(); })
      .def_property_readonly("file", [](const Scenario& s) { return s.file(); })
      .def(
          "save", [](const Scenario& s, const std::filesystem::path& file) { s.save(file); }, py::arg("file"))
      .def_property_readonly("values_set",
                             [](const Scenario& s) {
                               py::list set;
                               for (const auto& [key, value] : s.values_set())
                                 set.append(py::make_tuple(key, object_of(value)));
                               return set;
                             })
      .def_property_readonly("changes", [](const Scenario& s) { return s.changes(); })
      .def_property_readonly("is_made", [](const Scenario& s) { return s.is_made(); })
      .def(
          "check",
          [](const Scenario& s, int realization) {
            return without_lock(s, [&](const Scenario& own) { return own.check(realization); });
          },
          py::arg("realization") = 0)
      .def(
          "cut",
          [](const Scenario& s, int realization) {
            return without_lock(s, [&](const Scenario& own) { return own.cut(realization); });
          },
          py::arg("realization") = 0)
      .def(
          "census",
          [](const Scenario& s, int realization, double factor) {
            return without_lock(s, [&](const Scenario& own) { return own.census(realization, factor); });
          },
          py::arg("realization") = 0, py::arg("factor") = 1.5);
  seal(scenario);
}

}  // namespace keyblock::python
