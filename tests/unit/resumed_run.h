#pragma once
#include <gtest/gtest.h>

#include "fresh_folder.h"
#include "scene.h"

namespace keyblock::simulation {

/// A run that an observer with a flag `stop` interrupts, and that goes on from its checkpoint.
template <typename Stopping>
record::RunRecord resumed_run(const RunSetup& setup, Stopping& stopper) {
  const FreshFolder folder;
  RunOptions options;
  options.directory = folder;
  options.stop = &stopper.stop;
  EXPECT_TRUE(run(setup, options, stopper).interrupted);
  options.stop = nullptr;
  options.resume = true;
  record::RunObserver nobody;
  return run(setup, options, nobody);
}

}  // namespace keyblock::simulation
