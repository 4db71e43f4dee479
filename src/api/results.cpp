#include "keyblock/results.h"

#include "keyblock/keyblock.h"
#include "results/run_data.h"
#include "results/summary.h"

namespace keyblock {

struct Results::Parts {
  results::RunData data;
};

Results::Results(const std::filesystem::path& folder)
    : parts_(std::make_unique<Parts>(Parts{results::read_run(folder)})) {}
Results::~Results() = default;
Results::Results(Results&&) noexcept = default;
Results& Results::operator=(Results&&) noexcept = default;

std::string Results::summary() const {
  return results::summary_json(parts_->data.model, parts_->data.run);
}

std::size_t Results::blocks() const {
  return parts_->data.model.blocks.size();
}

std::size_t Results::frames() const {
  return parts_->data.frames.size();
}

Frame Results::frame(std::size_t k) const {
  const simulation::Frame& of = parts_->data.frames.at(k);
  Frame frame{of.time, of.stage, of.step, of.displacement, of.stress, {}};
  for (const simulation::BlockStatus status : of.status)
    frame.status.push_back(static_cast<unsigned char>(status));
  return frame;
}

std::vector<std::array<double, 2>> Results::vertices() const {
  std::vector<std::array<double, 2>> points;
  for (const Vec2 p : parts_->data.model.vertices) points.push_back({p.x, p.y});
  return points;
}

std::vector<std::vector<std::array<int, 2>>> Results::rings() const {
  std::vector<std::vector<std::array<int, 2>>> blocks;
  for (const simulation::ModelRecord::Block& block : parts_->data.model.blocks) {
    auto& rings = blocks.emplace_back();
    for (std::size_t r = 0; r + 1 < block.ring_start.size(); ++r)
      rings.push_back({block.ring_start[r], block.ring_start[r + 1]});
  }
  return blocks;
}

std::array<double, 2> Results::origin() const {
  return {parts_->data.model.origin.x, parts_->data.model.origin.y};
}

}  // namespace keyblock
