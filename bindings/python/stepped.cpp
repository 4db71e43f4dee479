#include "stepped.h"

namespace py = pybind11;

namespace keyblock::python {

long Stepped::advance(long steps, const py::object& after_step, const py::object& progress) {
  const Stepping now(*this);
  take_over();
  simulation_->after_step(after_step.is_none() ? std::function<void()>() : [&] { call(after_step); });
  simulation_->on_progress(progress.is_none() ? std::function<void(const Progress&)>()
                                              : [&](const Progress& at) {
                                                  const py::gil_scoped_acquire lock;
                                                  progress(py::cast(at));
                                                });
  const long first = simulation_->step();
  try {
    for (bool more = true; more && simulation_->step() - first < steps;) {
      {
        const py::gil_scoped_release free;
        more = simulation_->advance();
      }
      refresh();
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  } catch (...) {
    refresh();
    simulation_->after_step({});
    simulation_->on_progress({});
    throw;
  }
  simulation_->after_step({});
  simulation_->on_progress({});
  return simulation_->step() - first;
}

}  // namespace keyblock::python
