#pragma once
#include <filesystem>
#include <string>

#include "record/record.h"

namespace keyblock::results {

/// m². The frame around a domain counts nowhere.
struct Areas {
  double blocks = 0.0;     ///< except for those in `excavated`
  double excavated = 0.0;  ///< of blocks inside excavations that were opened
  double domain = 0.0;
};
Areas areas(const record::ModelRecord& model, const record::RunRecord& run);

/// What a run came to, for people and scripts: the fields are described in the user guide. Areas in m², times in s;
/// every number can be read back to its last bit; what is not a number is null.
///
/// The frame around a domain counts nowhere. `vertices` are the display vertices of the blocks (ModelRecord).
/// `area` is `areas`. `joints` are the traces of which some piece bounds two blocks.
std::string summary_json(const record::ModelRecord& model, const record::RunRecord& run);

/// Writes DIR/summary.json at once. Throws RunError.
void write_summary(const std::filesystem::path& directory, const record::ModelRecord& model,
                   const record::RunRecord& run);

}  // namespace keyblock::results
