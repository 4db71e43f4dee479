#include "simulation/run.h"

#include "core/out_of_memory.h"
#include "simulation/feasibility.h"
#include "simulation/runner.h"

namespace keyblock::simulation {

record::RunRecord run(const RunSetup& setup, const RunOptions& options, record::RunObserver& observer) {
  return with_memory_for([&] { return memory_purpose(setup); },
                         [&] {
                           Runner runner(setup, options, observer);
                           while (!runner.done()) runner.advance();
                           return runner.finish();
                         });
}

}  // namespace keyblock::simulation
