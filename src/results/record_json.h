#pragma once
#include <string>

#include "record/record.h"

/// Records as JSON, each number to its last bit: what the result file holds as text. See docs/result-file.md.
namespace keyblock::results {

std::string model_json(const record::ModelRecord& model);  ///< except for what the result file has as arrays
std::string stage_json(int index, const record::StageRecord& stage, bool ended);
std::string run_json(const record::RunRecord& run);  ///< without its stages

struct StageLine {
  int index = 0;
  bool ended = false;
  record::StageRecord stage;
};
/// These throw InputError (without a file name) for text that is not what the functions above write.
void read_model_json(const std::string& text, record::ModelRecord& model);
StageLine read_stage_json(const std::string& text);
record::RunRecord read_run_json(const std::string& text);

}  // namespace keyblock::results
