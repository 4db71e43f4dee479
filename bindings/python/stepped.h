#pragma once
#include <pybind11/numpy.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "keyblock/simulation.h"
#include "shared_array.h"

namespace keyblock::python {

/// A Simulation that Python may call from any thread at any time: what does not fit the moment is refused. Every call holds the
/// interpreter's lock; a step gives it back meanwhile.
class Stepped {
 public:
  Stepped(const Scenario& scenario, const RunOptions& options)
      : own_(begin(scenario, options)), simulation_(&*own_) {}
  /// Of a run that a study takes step by step.
  explicit Stepped(Simulation& of) : simulation_(&of) {}

  /// Steps that were taken: fewer than asked for when the run has come to its end.
  long advance(long steps, const pybind11::object& after_step, const pybind11::object& progress);
  std::string finish() {
    const Stepping now(*this);
    const pybind11::gil_scoped_release free;
    return simulation_->finish();
  }
  void close() {
    const Stepping now(*this);
    const pybind11::gil_scoped_release free;
    simulation_->close();
  }
  void stop() noexcept {
    if (simulation_ != nullptr) simulation_->stop();
  }

  [[nodiscard]] const Simulation& at_rest() const {
    check_access();
    return *simulation_;
  }
  Simulation& at_rest() {
    check_access();
    return *simulation_;
  }
  /// Calls a function of Python within a step that somebody else has taken.
  void steer(const pybind11::object& function) {
    const Stepping now(*this);
    call(function);
  }
  /// The run has ended: nothing can be asked of it any more.
  void release() { simulation_ = nullptr; }
  pybind11::array_t<double> velocity() {
    check_access();
    return velocity_.array(simulation_->velocity(), 1, true);
  }
  pybind11::array_t<double> vertices() {
    check_access();
    return vertices_.array(simulation_->vertices(), 2, false);
  }
  void set_velocity(
      const pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>& values) {
    check_access();
    simulation_->set_velocity({values.data(), static_cast<std::size_t>(values.size())});
    velocity_.refresh(simulation_->velocity());
  }

 private:
  static Simulation begin(const Scenario& scenario, const RunOptions& options) {
    const Scenario own = scenario;  // other threads of Python may change it meanwhile
    const pybind11::gil_scoped_release free;
    return Simulation(own, options);
  }

  /// While it lives, this thread is in a step.
  class Stepping {
   public:
    explicit Stepping(Stepped& of) : of_(of) {
      of_.check_there();
      if (of_.stepping_) throw std::runtime_error("the simulation is within a step");
      of_.stepping_ = std::this_thread::get_id();
    }
    ~Stepping() { of_.stepping_.reset(); }
    Stepping(const Stepping&) = delete;
    Stepping& operator=(const Stepping&) = delete;

   private:
    Stepped& of_;
  };

  void check_there() const {
    if (simulation_ == nullptr) throw std::runtime_error("the run has ended");
  }
  void check_access() const {
    check_there();
    if (stepping_ && !(in_callback_ && *stepping_ == std::this_thread::get_id()))
      throw std::runtime_error("the simulation is within a step of another thread");
  }
  /// Velocities that Python has written come into force.
  void take_over() {
    if (!velocity_.differs(simulation_->velocity())) return;
    try {
      simulation_->set_velocity(velocity_.values());
    } catch (...) {
      velocity_.put(simulation_->velocity());
      throw;
    }
  }
  void refresh() {
    velocity_.refresh(simulation_->velocity());
    vertices_.refresh(simulation_->vertices());
  }
  void call(const pybind11::object& function) {
    const pybind11::gil_scoped_acquire lock;
    refresh();
    in_callback_ = true;
    try {
      function();
      take_over();
    } catch (...) {
      in_callback_ = false;
      throw;
    }
    in_callback_ = false;
  }

  std::optional<Simulation> own_;
  Simulation* simulation_;  ///< null: the run has ended
  std::optional<std::thread::id> stepping_;
  bool in_callback_ = false;
  SharedArray<double> velocity_, vertices_;
};

}  // namespace keyblock::python
