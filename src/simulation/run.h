#pragma once
#include "record/record.h"
#include "simulation/run_options.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Runs all stages of `setup`. Throws InputError for a model that cannot be built, RunError when a step cannot be
/// solved; the observer has then received everything up to that step, and end(). Step by step: runner.h.
record::RunRecord run(const RunSetup& setup, const RunOptions& options, record::RunObserver& observer);

}  // namespace keyblock::simulation
