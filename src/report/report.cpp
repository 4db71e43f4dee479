#include "report/report.h"

#include "core/atomic_file.h"
#include "report/page_data.h"
#include "report/page_template.h"
#include "report/viewer_template.h"

namespace keyblock::report {

std::string render_report(const results::RunData& run) {
  const PageData data = make_page_data(run);
  return fill_page(viewer_template(), run.model.title, data.header, data.arrays);
}

void write_report(const results::RunData& run, const std::filesystem::path& directory) {
  write_file_atomically(directory / "report.html", render_report(run));
}

}  // namespace keyblock::report
