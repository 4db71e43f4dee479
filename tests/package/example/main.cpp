// Lets a block slide, brakes it half-way, and reads the results.
#include <keyblock/keyblock.h>

#include <cstdio>
#include <exception>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    keyblock::Scenario scenario = keyblock::Scenario::load(argv[1]);
    scenario.set("title", "from a program");
    for (const std::string& warning : scenario.check()) std::printf("warning: %s\n", warning.c_str());
    std::printf("blocks %zu\n", scenario.cut().size());

    keyblock::RunOptions options;
    options.folder = argv[2];
    keyblock::Simulation run(scenario, options);
    long braked = 0;
    run.after_step([&] {
      if (run.step() != 100) return;
      std::vector<double> velocity(run.velocity().begin(), run.velocity().end());
      for (double& v : velocity) v *= 0.5;
      run.set_velocity(velocity);
      ++braked;
    });
    while (run.advance()) {
    }
    run.finish();
    std::printf("steps %ld braked %ld\n", run.step(), braked);

    const keyblock::Results results(argv[2]);
    std::printf("frames %zu\n", results.frames());
    scenario.set("rock.young", "-1");
    static_cast<void>(scenario.check());
  } catch (const keyblock::InputError& error) {
    std::printf("refused %s\n", error.diagnostics().front().key.c_str());
    return 0;
  } catch (const std::exception& error) {
    std::printf("failed: %s\n", error.what());
  }
  return 1;
}
