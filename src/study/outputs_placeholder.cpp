#include <fmt/format.h>

#include "core/atomic_file.h"
#include "study/outputs.h"

namespace keyblock::study {

void write_outputs(const std::filesystem::path& directory, const StudyData& study) {
  std::string text = "key,realization,variant,fallen_area_m2,state_hash\n";
  for (const RunResult& run : study.runs) {
    const double area = run.stages.empty() ? 0.0 : run.stages.back().damage.fallen_area;
    text += fmt::format("{},{},{},{},{}\n", run.key, run.realization, run.variant, area, run.state_hash);
  }
  write_file_atomically(directory / "runs.csv", text);
}

std::string thumbnail_svg(const simulation::ModelRecord&, const simulation::Frame&) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"/>\n";
}

}  // namespace keyblock::study
