#include "scenario/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "rockmass/trace_map.h"
#include "scenario/shaking_checks.h"

namespace keyblock::scenario {
namespace {

namespace fs = std::filesystem;

void append(std::vector<Diagnostic>& all, const InputError& error) {
  all.insert(all.end(), error.diagnostics().begin(), error.diagnostics().end());
}

// Without a domain, which is a mistake that is told elsewhere, there is none.
std::vector<rockmass::Trace> tessellated(const Scenario& scenario, rockmass::Tessellation tessellation,
                                         int index, int realization) {
  if (tessellation.region.empty()) {
    if (!scenario.domain) return {};
    const Box box = scenario.domain->box();
    tessellation.region = {box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}};
  }
  return rockmass::traces_of(rockmass::tessellation_lines(tessellation, scenario.seed, realization, index),
                             index);
}

}  // namespace

std::vector<fs::path> input_paths(const Scenario& scenario) {
  std::set<fs::path> paths;
  for (const TraceMapSpec& map : scenario.trace_maps) {
    if (!map.file.empty()) paths.insert(map.file);
  }
  paths.insert(scenario.drawings.begin(), scenario.drawings.end());
  for (const SuiteSpec& suite : scenario.suites) paths.insert(suite.file);
  for (const MotionSpec& motion : scenario.motions) {
    for (const MotionComponentSpec& component : motion.components) paths.insert(component.file);
  }
  return {paths.begin(), paths.end()};
}

std::vector<simulation::InputFile> input_files(const Scenario& scenario) {
  const fs::path folder = fs::absolute(scenario.file).lexically_normal().parent_path();
  std::vector<simulation::InputFile> files;
  for (const fs::path& path : input_paths(scenario)) {
    const std::string content = read_file(path);
    Hash hash;
    hash.add(content.data(), content.size());
    files.push_back({fs::absolute(path).lexically_normal().lexically_relative(folder).string(),
                     fmt::format("{:016x}", hash.value())});
  }
  return files;
}

std::vector<rockmass::Trace> read_trace_maps(const Scenario& scenario,
                                             std::vector<std::vector<rockmass::TraceStrength>>* strengths,
                                             std::vector<std::string>* skipped, int realization) {
  std::vector<rockmass::Trace> traces;
  std::vector<Diagnostic> mistakes;
  for (std::size_t k = 0; k < scenario.trace_maps.size(); ++k) {
    try {
      const TraceMapSpec& spec = scenario.trace_maps[k];
      const int index = static_cast<int>(k);
      if (spec.tessellation) {
        const auto map = tessellated(scenario, *spec.tessellation, index, realization);
        traces.insert(traces.end(), map.begin(), map.end());
        if (strengths != nullptr) strengths->emplace_back();
        continue;
      }
      std::vector<rockmass::TraceStrength> of_map;
      std::string words;
      const auto map = spec.file.empty()
                           ? rockmass::traces_of(spec.lines, index)
                           : rockmass::read_trace_map(spec.file, index, &of_map, spec.choice, &words);
      if (skipped != nullptr && !words.empty())
        skipped->push_back(spec.path + ": left out of the drawing: " + words);
      traces.insert(traces.end(), map.begin(), map.end());
      if (strengths != nullptr) strengths->push_back(std::move(of_map));
    } catch (const InputError& error) {
      append(mistakes, error);
    }
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return traces;
}

std::vector<std::string> check_inputs(const Scenario& scenario) {
  std::vector<std::string> warnings = plausibility_warnings(scenario);
  std::vector<Diagnostic> mistakes;
  try {
    read_trace_maps(scenario);
  } catch (const InputError& error) {
    append(mistakes, error);
  }
  try {
    add_shaking_warnings(scenario, read_motions(scenario, warnings), warnings);
  } catch (const InputError& error) {
    append(mistakes, error);
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return warnings;
}

}  // namespace keyblock::scenario
