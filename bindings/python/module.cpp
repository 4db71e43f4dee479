#include <pybind11/stl.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// Options of the command line, as they are called in Python: `--force` is replace=True, and of others the dashes go.
std::string in_python(std::string words) {
  constexpr std::pair<std::string_view, std::string_view> options[] = {{"--force", "replace=True"},
                                                                       {"--resume", "resume=True"},
                                                                       {"--set", "a set value,"},
                                                                       {"--from", "start"},
                                                                       {"--to", "stop"},
                                                                       {"--", ""}};
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  for (const auto& [option, argument] : options) {
    for (std::size_t at = 0; (at = words.find(option, at)) != std::string::npos;) {
      const std::size_t end = at + option.size();
      const bool goes_on = end < words.size() && is_letter(words[end]),
                 begins = at == 0 || words[at - 1] == ' ' || words[at - 1] == '(';
      if (begins && goes_on == (option == "--")) {
        words.replace(at, option.size(), argument);
        at += argument.size();
      } else {
        at = end;
      }
    }
  }
  return words;
}

void raise(const InputError& error) {
  std::vector<Diagnostic> diagnostics = error.diagnostics();
  for (Diagnostic& diagnostic : diagnostics) {
    if (diagnostic.where.file.starts_with("--")) diagnostic.where.file = in_python(diagnostic.where.file);
    diagnostic.found = in_python(diagnostic.found);
    diagnostic.expected = in_python(diagnostic.expected);
    diagnostic.hint = in_python(diagnostic.hint);
  }
  py::object value = py::reinterpret_borrow<py::object>(input_error)(in_python(error.what()));
  value.attr("diagnostics") = py::cast(diagnostics);
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
