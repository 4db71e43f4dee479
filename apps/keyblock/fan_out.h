#pragma once
#include <utility>
#include <vector>

#include "simulation/record.h"

namespace keyblock::app {

/// Passes a run on to several observers, in their order. Does not own them.
class FanOut : public simulation::RunObserver {
 public:
  explicit FanOut(std::vector<simulation::RunObserver*> observers) : observers_(std::move(observers)) {}

  void begin(const simulation::ModelRecord& r) override { to_all(&RunObserver::begin, r); }
  void stage_begin(int k, const simulation::StageRecord& r) override {
    to_all(&RunObserver::stage_begin, k, r);
  }
  void frame(const simulation::Frame& r) override { to_all(&RunObserver::frame, r); }
  void contacts(const simulation::ContactFrame& r) override { to_all(&RunObserver::contacts, r); }
  void history(const simulation::HistoryRow& r) override { to_all(&RunObserver::history, r); }
  void step(const simulation::StepRow& r) override { to_all(&RunObserver::step, r); }
  void progress(const simulation::Progress& r) override { to_all(&RunObserver::progress, r); }
  void stage_end(int k, const simulation::StageRecord& r) override { to_all(&RunObserver::stage_end, k, r); }
  void end(const simulation::RunRecord& r) override { to_all(&RunObserver::end, r); }

 private:
  template <class Call, class... Arguments>
  void to_all(Call call, const Arguments&... arguments) {
    for (simulation::RunObserver* observer : observers_) (observer->*call)(arguments...);
  }
  std::vector<simulation::RunObserver*> observers_;
};

}  // namespace keyblock::app
