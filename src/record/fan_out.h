#pragma once
#include <utility>
#include <vector>

#include "record/record.h"

namespace keyblock::record {

/// Passes a run on to several observers, in their order. Does not own them.
class FanOut : public RunObserver {
 public:
  explicit FanOut(std::vector<RunObserver*> observers) : observers_(std::move(observers)) {}

  void begin(const ModelRecord& r) override { to_all(&RunObserver::begin, r); }
  void resume(const Reported& r) override { to_all(&RunObserver::resume, r); }
  void stage_begin(int k, const StageRecord& r) override { to_all(&RunObserver::stage_begin, k, r); }
  void frame(const Frame& r) override { to_all(&RunObserver::frame, r); }
  void contacts(const ContactFrame& r) override { to_all(&RunObserver::contacts, r); }
  void history(const HistoryRow& r) override { to_all(&RunObserver::history, r); }
  void breaks(const BreakRecord& r) override { to_all(&RunObserver::breaks, r); }
  void step(const StepRow& r) override { to_all(&RunObserver::step, r); }
  void checkpoint() override { to_all(&RunObserver::checkpoint); }
  void progress(const Progress& r) override { to_all(&RunObserver::progress, r); }
  void stage_end(int k, const StageRecord& r) override { to_all(&RunObserver::stage_end, k, r); }
  void end(const RunRecord& r) override { to_all(&RunObserver::end, r); }

 private:
  template <class Call, class... Arguments>
  void to_all(Call call, const Arguments&... arguments) {
    for (RunObserver* observer : observers_) (observer->*call)(arguments...);
  }
  std::vector<RunObserver*> observers_;
};

}  // namespace keyblock::record
