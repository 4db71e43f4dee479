// The attributes of result.h5 that hold records as JSON. HDF5 itself is not tried.
#include "record/record.h"
#include "results/record_json.h"
#include "try.h"

namespace keyblock::fuzz {

void try_bytes(std::string_view bytes) {
  if (bytes.empty()) return;
  const std::string text(bytes.substr(1));
  // The first letter says what the text is read as.
  switch (bytes.front()) {
    case 'm': {
      record::ModelRecord model;
      results::read_model_json(text, model);
      static_cast<void>(results::model_json(model));
      break;
    }
    case 's': {
      const results::StageLine line = results::read_stage_json(text);
      static_cast<void>(results::stage_json(line.index, line.stage, line.ended));
      break;
    }
    default:
      static_cast<void>(results::run_json(results::read_run_json(text)));
  }
}

}  // namespace keyblock::fuzz
