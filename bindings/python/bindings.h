#pragma once
#include <pybind11/pybind11.h>

#include <memory>

namespace keyblock::python {

class Stepped;

/// Nothing but the module makes objects of this class: `Class.__new__(Class)` would be one without a value, and its first use would break
/// the interpreter.
template <typename Class>
void seal(Class& of) {
  reinterpret_cast<PyTypeObject*>(of.ptr())->tp_new = nullptr;
}

/// InputError with its diagnostics, RunError, and what they are in Python.
void bind_errors(pybind11::module_& module);
void bind_scenario(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
/// Contacts of a simulation: column by column, so that only what is looked at is copied.
void bind_contacts(pybind11::class_<Stepped, std::shared_ptr<Stepped>>& simulation);
void bind_study(pybind11::module_& module);

}  // namespace keyblock::python
