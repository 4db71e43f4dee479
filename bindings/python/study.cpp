#include "keyblock/study.h"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <exception>
#include <utility>

#include "bindings.h"
#include "keyblock/keyblock.h"

namespace py = pybind11;

namespace keyblock::python {
namespace {

using Told = std::function<bool(std::size_t, std::size_t)>;

/// Calls `work` without the lock of the interpreter, with workers that tell `progress` and listen to Ctrl-C. What Python throws meanwhile
/// stops them and comes out.
template <class Work>
auto with_workers(int count, std::vector<std::string> command, const py::object& progress, const Work& work) {
  std::exception_ptr failure;
  Workers workers{count, std::move(command), {}};
  workers.progress = [&](std::size_t ended, std::size_t all) {
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!progress.is_none()) progress(ended, all);
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
    return !failure;
  };
  const auto throw_failure = [&] {
    if (failure) std::rethrow_exception(failure);
  };
  try {
    if constexpr (std::is_void_v<decltype(work(workers))>) {
      {
        const py::gil_scoped_release free;
        work(workers);
      }
      throw_failure();
    } else {
      auto result = [&] {
        const py::gil_scoped_release free;
        return work(workers);
      }();
      throw_failure();
      return result;
    }
  } catch (...) {
    throw_failure();
    throw;
  }
}

std::string limit(const Scenario& scenario, const std::filesystem::path& folder, LimitRequest request,
                  int count, std::vector<std::string> command, const py::object& progress) {
  const Scenario own = scenario;
  return with_workers(count, std::move(command), progress,
                      [&](const Workers& workers) { return find_limit(own, folder, request, workers); });
}

}  // namespace

void bind_study(py::module_& module) {
  const auto free = py::call_guard<py::gil_scoped_release>();
  module.def(
      "plan_study",
      [](const Scenario& scenario, const std::filesystem::path& folder, bool resume) {
        const Scenario own = scenario;
        const py::gil_scoped_release unlocked;
        return plan_study(own, folder, resume);
      },
      py::arg("scenario").none(false), py::arg("folder"), py::arg("resume") = false);
  module.def(
      "study_state",
      [](const std::filesystem::path& folder) {
        const StudyState state = study_state(folder);
        return std::make_tuple(state.runs, state.missing, state.failures);
      },
      py::arg("folder"));
  module.def(
      "run_of_study", [](const std::filesystem::path& folder, std::size_t run) { run_of_study(folder, run); },
      py::arg("folder"), py::arg("run"), free);
  module.def("note_failed_run", &note_failed_run, py::arg("folder"), py::arg("run"), py::arg("why"), free);
  module.def("collect_study", &collect_study, py::arg("folder"), free);
  module.def(
      "run_study",
      [](const std::filesystem::path& folder, int count, std::vector<std::string> command,
         const py::object& progress) {
        with_workers(count, std::move(command), progress,
                     [&](const Workers& workers) { run_study(folder, workers); });
      },
      py::arg("folder"), py::arg("workers"), py::arg("command"), py::arg("progress") = py::none());
  module.def(
      "find_limit",
      [](const Scenario& scenario, const std::filesystem::path& folder, const std::string& key, double from,
         double to, const std::string& until, std::optional<double> above, const std::string& since,
         double tolerance, int realizations, bool resume, int scan, int workers,
         std::vector<std::string> command, const py::object& progress) {
        return limit(scenario, folder,
                     {key, from, to, until, above, since, tolerance, realizations, resume, scan}, workers,
                     std::move(command), progress);
      },
      py::arg("scenario").none(false), py::arg("folder"), py::kw_only(), py::arg("key"), py::arg("start"),
      py::arg("stop"), py::arg("until"), py::arg("above"), py::arg("since"), py::arg("tolerance"),
      py::arg("realizations"), py::arg("resume"), py::arg("scan"), py::arg("workers"), py::arg("command"),
      py::arg("progress"));
  module.def(
      "verify",
      [](const std::filesystem::path& cases, std::vector<std::string> names, std::vector<int> orders,
         bool all, int count, const py::object& progress) {
        return with_workers(count, {}, progress, [&](const Workers& workers) {
          return verify({cases, names, orders, all, workers.count, workers.progress});
        });
      },
      py::arg("cases"), py::kw_only(), py::arg("names"), py::arg("orders"), py::arg("all"),
      py::arg("workers"), py::arg("progress"));
  module.def(
      "export_run",
      [](const std::filesystem::path& run, const std::filesystem::path& folder, const std::string& format,
         bool replace) { return Results(run).export_to(folder, format, replace); },
      py::arg("run"), py::arg("folder"), py::arg("format"), py::arg("replace"), free);
}

}  // namespace keyblock::python
