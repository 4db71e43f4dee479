#include "results/stage_ends.h"

#include <fmt/format.h>

#include <cctype>

namespace keyblock::results {
namespace {

// A stage's name as a part of a file name: what of it is plain, and as much as file systems take.
std::string file_part(const std::string& name) {
  constexpr std::size_t longest = 100;
  std::string out;
  for (const char c : name) {
    if (out.size() == longest) break;
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128;
    if (plain)
      out += c;
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

}  // namespace

std::vector<StageEnd> stage_ends(const RunData& data, std::string_view extension) {
  std::vector<StageEnd> ends;
  for (std::size_t k = 0; k < data.run.stages.size(); ++k) {
    const record::Frame* last = nullptr;
    for (const record::Frame& frame : data.frames) {
      if (frame.stage == static_cast<int>(k)) last = &frame;
    }
    if (last == nullptr) continue;
    const record::StageRecord& record = data.run.stages[k];
    const std::string part = file_part(record.stage.name);
    ends.push_back({fmt::format("stage_{}{}{}{}{}", k + 1, part.empty() ? "" : "_", part,
                                record.interrupted ? "_unfinished" : "", extension),
                    last});
  }
  return ends;
}

}  // namespace keyblock::results
