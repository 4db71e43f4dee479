#include "keyblock/study.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.h"

namespace py = pybind11;

namespace keyblock::python {

void bind_study(py::module_& module) {
  const auto free = py::call_guard<py::gil_scoped_release>();
  module.def("plan_study", &plan_study, py::arg("scenario").none(false), py::arg("folder"),
             py::arg("resume") = false, free);
  module.def(
      "study_state",
      [](const std::filesystem::path& folder) {
        const StudyState state = study_state(folder);
        return std::make_tuple(state.runs, state.missing, state.failures);
      },
      py::arg("folder"));
  module.def("run_of_study", &run_of_study, py::arg("folder"), py::arg("run"), free);
  module.def("collect_study", &collect_study, py::arg("folder"), free);
}

}  // namespace keyblock::python
