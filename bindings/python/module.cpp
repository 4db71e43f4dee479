#include <pybind11/stl.h>

#include <string>

#include "bindings.h"
#include "keyblock/keyblock.h"

namespace py = pybind11;

namespace keyblock::python {
namespace {

// Live as long as the interpreter.
PyObject* input_error = nullptr;
PyObject* run_error = nullptr;

PyObject* make_error(py::module_& module, const char* name, const char* meaning, PyObject* base) {
  const std::string full = std::string("keyblock.") + name;
  PyObject* error = PyErr_NewExceptionWithDoc(full.c_str(), meaning, base, nullptr);
  if (error == nullptr) throw py::error_already_set();
  module.attr(name) = py::reinterpret_borrow<py::object>(error);
  return error;
}

void raise(const InputError& error) {
  py::object value = py::reinterpret_borrow<py::object>(input_error)(error.what());
  value.attr("diagnostics") = py::cast(error.diagnostics());
  PyErr_SetObject(input_error, value.ptr());
}

}  // namespace

void bind_errors(py::module_& module) {
  py::class_<Diagnostic> diagnostic(module, "Diagnostic", py::is_final(), "One mistake in the input.");
  diagnostic.def_property_readonly("file", [](const Diagnostic& d) { return d.where.file; })
      .def_property_readonly(
          "line", [](const Diagnostic& d) { return d.where.line; }, "Counts from 1; 0: unknown.")
      .def_property_readonly(
          "column", [](const Diagnostic& d) { return d.where.column; }, "Counts from 1; 0: unknown.")
      .def_readonly("key", &Diagnostic::key, "Full key path; empty where no key is meant.")
      .def_readonly("found", &Diagnostic::found)
      .def_readonly("expected", &Diagnostic::expected)
      .def_readonly("hint", &Diagnostic::hint)
      .def("__str__", [](const Diagnostic& d) { return d.to_string(); })
      .def("__repr__", [](const Diagnostic& d) { return "<keyblock.Diagnostic " + d.to_string() + ">"; });
  seal(diagnostic);
  input_error = make_error(module, "InputError", "The input is wrong; `diagnostics` has every mistake found.",
                           PyExc_ValueError);
  run_error = make_error(module, "RunError", "The run could not go on; what was computed so far is kept.",
                         PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const InputError& error) {
      raise(error);
    } catch (const RunError& error) {
      PyErr_SetString(run_error, error.what());
    }
  });
}

}  // namespace keyblock::python

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of keyblock. Use the package `keyblock`.";
  module.attr("__version__") = keyblock::version();
  keyblock::python::bind_errors(module);
  keyblock::python::bind_scenario(module);
  keyblock::python::bind_simulation(module);
  keyblock::python::bind_study(module);
}
