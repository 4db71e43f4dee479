#include "study/outputs.h"

#include "core/atomic_file.h"
#include "study/study_json.h"
#include "study/study_page.h"

namespace keyblock::study {

Summary write_outputs(const std::filesystem::path& directory, const StudyData& study) {
  Summary summary = summarize(study);
  const std::string json = study_json(study, summary);
  write_file_atomically(directory / "runs.csv", runs_csv(study, summary));
  write_file_atomically(directory / "study.json", json);
  write_file_atomically(directory / "report.html", study_page(directory, study, summary, json));
  return summary;
}

}  // namespace keyblock::study
