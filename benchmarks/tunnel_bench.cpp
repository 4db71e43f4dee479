#include <benchmark/benchmark.h>

#include "scenario/build.h"
#include "scenario/parse.h"
#include "simulation/run.h"

/// The tunnel of the first example.
namespace {

using keyblock::record::Stage;
using keyblock::simulation::RunSetup;

keyblock::scenario::Scenario tunnel() {
  return keyblock::scenario::parse_scenario(KEYBLOCK_SOURCE_DIR "/examples/01-tunnel.toml");
}

void cut(benchmark::State& state) {
  const auto scenario = tunnel();
  for (auto _ : state) benchmark::DoNotOptimize(keyblock::scenario::build_blocks(scenario, 0));
}
BENCHMARK(cut)->Unit(benchmark::kMillisecond);

/// Dynamic steps of the rock at rest, before the excavation, with range(0) threads and order range(1).
void steps_at_rest(benchmark::State& state) {
  RunSetup setup = keyblock::scenario::build_setup(tunnel(), 0);
  for (auto& block : setup.properties) block.order = static_cast<int>(state.range(1));
  Stage stage;
  stage.name = "rest";
  stage.kind = keyblock::record::StageKind::rest;
  stage.duration = 200 * setup.time_step;
  setup.stages = {stage};
  keyblock::simulation::RunOptions options;
  options.threads = static_cast<int>(state.range(0));
  keyblock::record::RunObserver nobody;
  double wall_time = 0.0;
  long steps = 0;
  for (auto _ : state) {
    const auto record = keyblock::simulation::run(setup, options, nobody);
    wall_time += record.wall_time;
    steps += record.steps;
  }
  state.counters["ms_per_step"] = 1e3 * wall_time / static_cast<double>(steps);
}
BENCHMARK(steps_at_rest)
    ->ArgNames({"threads", "order"})
    ->Args({1, 1})
    ->Args({2, 1})
    ->Args({1, 2})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
