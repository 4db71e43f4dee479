#include "keyblock/simulation.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "array_of.h"
#include "bindings.h"
#include "keyblock/study.h"
#include "stepped.h"

namespace py = pybind11;

namespace keyblock::python {
namespace {

py::dict by_name(const std::vector<std::pair<std::string, double>>& values) {
  py::dict named;
  for (const auto& [name, value] : values) named[name.c_str()] = value;
  return named;
}

void bind_values(py::module_& module) {
  py::class_<Progress> progress(module, "Progress", py::is_final(), "How far a run is.");
  progress.def_readonly("stage", &Progress::stage)
      .def_readonly("stages", &Progress::stages)
      .def_readonly("stage_name", &Progress::stage_name)
      .def_readonly("fraction", &Progress::fraction, "Of the stage, 0 to 1; an estimate in static stages.")
      .def_readonly("time", &Progress::time, "s, simulated in the stage.")
      .def_readonly("step", &Progress::step)
      .def_readonly("seconds_left", &Progress::seconds_left, "Of the stage; negative: unknown.");
  seal(progress);
}

}  // namespace

namespace {

/// One run of a study, with `steer` called after each step with the simulation of the run.
void run_steered(const std::filesystem::path& folder, std::size_t run,
                 const std::vector<std::pair<std::string, std::string>>& hooks, const py::object& steer) {
  std::shared_ptr<Stepped> stepped;
  py::object function;
  const auto let_go = [&] {
    if (stepped) stepped->release();
    function = py::object();
  };
  try {
    const py::gil_scoped_release free;
    run_of_study(folder, run, hooks, [&](Simulation& simulation) {
      const py::gil_scoped_acquire lock;
      if (!stepped) {
        stepped = std::make_shared<Stepped>(simulation);
        function = steer(py::cast(stepped));
      }
      stepped->steer(function);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
  } catch (...) {
    let_go();
    throw;
  }
  let_go();
}

using SimulationClass = py::class_<Stepped, std::shared_ptr<Stepped>>;

/// Where blocks are, and what acts on them.
void bind_state(SimulationClass& simulation) {
  simulation.def_property_readonly("vertices", [](Stepped& s) { return s.vertices(); })
      .def_property(
          "velocity", [](Stepped& s) { return s.velocity(); },
          [](Stepped& s, const py::array_t<double, py::array::c_style | py::array::forcecast>& values) {
            s.set_velocity(values);
          })
      .def_property_readonly("first_vertex",
                             [](const Stepped& s) {
                               const std::span<const int> first = s.at_rest().first_vertex();
                               return array_of(std::vector<int>(first.begin(), first.end()));
                             })
      .def_property_readonly("first_coefficient",
                             [](const Stepped& s) {
                               // Signed: with unsigned numbers, first_coefficient + 1 would be no integer in numpy.
                               const auto first = s.at_rest().first_coefficient();
                               return array_of(std::vector<std::int64_t>(first.begin(), first.end()));
                             })
      .def_property_readonly("present",
                             [](const Stepped& s) {
                               const std::span<const std::uint8_t> there = s.at_rest().present();
                               return array_of(std::vector<std::uint8_t>(there.begin(), there.end()));
                             })
      .def_property_readonly("centroids",
                             [](const Stepped& s) { return array_of(s.at_rest().centroids(), 2); })
      .def_property_readonly("block_velocities",
                             [](const Stepped& s) { return array_of(s.at_rest().block_velocities(), 2); })
      .def_property_readonly("block_facts",
                             [](const Stepped& s) {
                               py::list blocks;
                               for (const BlockFacts& b : s.at_rest().block_facts())
                                 blocks.append(py::make_tuple(b.name, b.excavations, b.fixed, b.area,
                                                              b.density, b.young, b.poisson));
                               return blocks;
                             })
      .def_property_readonly("origin", [](const Stepped& s) { return s.at_rest().origin(); })
      .def_property_readonly("stress", [](const Stepped& s) { return array_of(s.at_rest().stress(), 3); })
      .def_property_readonly("status", [](const Stepped& s) { return array_of(s.at_rest().status()); })
      .def_property_readonly("damage", [](const Stepped& s) { return by_name(s.at_rest().damage()); })
      .def_property_readonly("ground_acceleration",
                             [](const Stepped& s) { return s.at_rest().ground_acceleration(); })
      .def_property_readonly("springs",
                             [](const Stepped& s) {
                               py::list springs;
                               for (const SpringState& k : s.at_rest().springs())
                                 springs.append(py::make_tuple(k.name, k.from, k.to, k.length, k.stiffness,
                                                               k.force, k.yield, k.is_there));
                               return springs;
                             })
      .def_property_readonly("forces",
                             [](const Stepped& s) {
                               py::list forces;
                               for (const AppliedForce& f : s.at_rest().forces())
                                 forces.append(py::make_tuple(f.block, f.slot, f.force));
                               return forces;
                             })
      .def_property_readonly("energy", [](const Stepped& s) { return by_name(s.at_rest().energy()); });
}

/// Strengths, and what a program may change between steps.
void bind_changes(SimulationClass& simulation) {
  simulation
      .def("strength",
           [](const Stepped& s, const std::string& joint) {
             const JointStrength strength = s.at_rest().strength(joint);
             return std::make_tuple(strength.friction, strength.cohesion, strength.tension);
           })
      .def("set_strength",
           [](Stepped& s, const std::string& joint, double friction, double cohesion, double tension) {
             s.at_rest().set_strength(joint, {friction, cohesion, tension});
           })
      .def("set_load_factor",
           [](Stepped& s, std::size_t load, double factor) { s.at_rest().set_load_factor(load, factor); })
      .def(
          "set_force",
          [](Stepped& s, std::size_t block, std::array<double, 2> force,
             std::optional<std::array<double, 2>> place,
             std::int64_t slot) { s.at_rest().set_force(block, force, place, slot); },
          py::arg("block"), py::arg("force"), py::arg("place"), py::arg("slot"))
      .def("set_spring_stiffness", [](Stepped& s, std::size_t spring,
                                      double value) { s.at_rest().set_spring_stiffness(spring, value); })
      .def("set_spring_force",
           [](Stepped& s, std::size_t spring, double value) { s.at_rest().set_spring_force(spring, value); })
      .def("set_motion_scale", [](Stepped& s, double factor) { s.at_rest().set_motion_scale(factor); });
}

}  // namespace

void bind_simulation(py::module_& module) {
  bind_values(module);
  module.def("run_of_study_steered", &run_steered, py::arg("folder"), py::arg("run"), py::arg("hooks"),
             py::arg("steer"));
  // Functions take references: a method by its address would take None for the object, and use it.
  SimulationClass simulation(module, "Simulation", py::is_final(), "A run, step by step.");
  simulation
      .def_static(
          "begin",
          [](const Scenario& scenario, const std::filesystem::path& folder, int realization, int threads,
             bool resume, bool replace, std::vector<std::pair<std::string, std::string>> hooks) {
            return std::make_shared<Stepped>(
                scenario, RunOptions{folder, realization, threads, resume, replace, std::move(hooks)});
          },
          py::arg("scenario"), py::kw_only(), py::arg("folder") = "", py::arg("realization") = 0,
          py::arg("threads") = 1, py::arg("resume") = false, py::arg("replace") = false,
          py::arg("hooks") = std::vector<std::pair<std::string, std::string>>())
      .def(
          "advance",
          [](Stepped& s, long steps, const py::object& after_step, const py::object& progress) {
            return s.advance(steps, after_step, progress);
          },
          py::arg("steps") = 1, py::arg("after_step") = py::none(), py::arg("progress") = py::none())
      .def("finish", [](Stepped& s) { return s.finish(); })
      .def("close", [](Stepped& s) { s.close(); })
      .def("stop", [](Stepped& s) { s.stop(); })
      .def_property_readonly("done", [](const Stepped& s) { return s.at_rest().done(); })
      .def_property_readonly("time", [](const Stepped& s) { return s.at_rest().time(); })
      .def_property_readonly("step", [](const Stepped& s) { return s.at_rest().step(); })
      .def_property_readonly("stage", [](const Stepped& s) { return s.at_rest().stage(); })
      .def_property_readonly("stages", [](const Stepped& s) { return s.at_rest().stages(); })
      .def_property_readonly("warnings", [](const Stepped& s) { return s.at_rest().warnings(); })
      .def_property_readonly("state_hash", [](const Stepped& s) { return s.at_rest().state_hash(); })
      .def_property_readonly("blocks", [](const Stepped& s) { return s.at_rest().blocks(); });
  bind_state(simulation);
  bind_changes(simulation);
  bind_contacts(simulation);
  seal(simulation);
}

}  // namespace keyblock::python
