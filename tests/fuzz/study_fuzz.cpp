// The plan of a study and the measures of a run, as a folder of somebody else may hold them.
#include "places.h"
#include "study/folder.h"
#include "study/plan.h"
#include "study/plan_json.h"
#include "study/run_json.h"
#include "try.h"

namespace keyblock::fuzz {

void try_bytes(std::string_view bytes) {
  static const TemporaryFolder folder;
  // A text that begins with 'r' holds the measures of a run, without their checksum, which is always right.
  if (bytes.starts_with('r')) {
    const std::string text(bytes.substr(1));
    static_cast<void>(
        study::read_run_json(text + ",\"checksum\":\"" + study::hash_text(text) + "\"}\n", "input"));
    return;
  }
  write(study::plan_path(folder.path()), bytes);
  write(study::scenario_path(folder.path()), "title = \"t\"\n");
  static_cast<void>(study::read_plan(folder.path()));
}

}  // namespace keyblock::fuzz
