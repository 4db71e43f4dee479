#include "report/joint_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace keyblock::report {

namespace {

/// Sine of the largest angle between two pieces of one straight edge.
constexpr double straight_sine = 1e-6;

struct Foot {
  double score = std::numeric_limits<double>::infinity();
  std::size_t piece = 0;
  double share = 0.0;
};

}  // namespace

JointLocator::JointLocator(const simulation::ModelRecord& model)
    : model_(model), chains_(model.blocks.size()) {
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const auto& start = model.blocks[b].ring_start;
    for (std::size_t r = 0; r + 1 < start.size(); ++r) {
      std::vector<std::uint32_t> ring(static_cast<std::size_t>(start[r + 1] - start[r]));
      std::iota(ring.begin(), ring.end(), static_cast<std::uint32_t>(start[r]));
      if (ring.size() >= 3) add_ring(ring, chains_[b]);
    }
  }
}

void JointLocator::add_ring(std::span<const std::uint32_t> ring, std::vector<Chain>& chains) const {
  const std::size_t n = ring.size();
  const auto at = [&](std::size_t i) { return ring[i % n]; };
  const auto turns = [&](std::size_t i) {
    const Vec2 in = model_.vertices[at(i)] - model_.vertices[at(i + n - 1)];
    const Vec2 out = model_.vertices[at(i + 1)] - model_.vertices[at(i)];
    return std::abs(cross(in, out)) > straight_sine * norm(in) * norm(out) || dot(in, out) < 0.0 ||
           !(model_.edge_label[at(i + n - 1)] == model_.edge_label[at(i)]);
  };
  std::size_t first = 0;
  while (first < n && !turns(first)) ++first;
  Chain chain;
  for (std::size_t k = 0; k < n; ++k) {
    chain.vertices.push_back(at(first + k));
    if (k + 1 == n || turns(first + k + 1)) {
      chain.vertices.push_back(at(first + k + 1));
      chains.push_back(std::move(chain));
      chain = {};
    }
  }
}

void JointLocator::locate(std::span<const simulation::ContactRecord> contacts,
                          std::span<const std::array<float, 2>> displacement,
                          std::vector<JointPiece>& pieces) const {
  const auto position = [&](std::uint32_t v) {
    return model_.vertices[v] + Vec2{double{displacement[v][0]}, double{displacement[v][1]}};
  };
  for (const simulation::ContactRecord& contact : contacts) {
    const Chain* best_chain = nullptr;
    Foot best;
    for (const Chain& chain : chains_[static_cast<std::size_t>(contact.block_b)]) {
      for (std::size_t k = 0; k + 1 < chain.vertices.size(); ++k) {
        const Vec2 from = position(chain.vertices[k]);
        const Vec2 along = position(chain.vertices[k + 1]) - from;
        const double length = norm(along);
        if (!(length > 0.0)) continue;
        const double share = std::clamp(dot(contact.position - from, along) / (length * length), 0.0, 1.0);
        const double distance = norm(contact.position - (from + share * along));
        const double facing = dot(contact.normal, -perpendicular(along)) / length;
        const double score = distance + contact.length * (1.0 - facing);
        if (score < best.score) {
          best = {score, k, share};
          best_chain = &chain;
        }
      }
    }
    if (best_chain == nullptr) continue;

    const auto& vertices = best_chain->vertices;
    std::vector<double> arc(vertices.size(), 0.0);
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k)
      arc[k + 1] = arc[k] + norm(position(vertices[k + 1]) - position(vertices[k]));
    const double foot = std::lerp(arc[best.piece], arc[best.piece + 1], best.share);
    const double begin =
        std::clamp(foot - 0.5 * contact.length, 0.0, std::max(0.0, arc.back() - contact.length));
    const double end = std::min(arc.back(), begin + contact.length);
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
      const double length = arc[k + 1] - arc[k];
      const double from = std::max(begin, arc[k]);
      const double to = std::min(end, arc[k + 1]);
      if (!(to > from)) continue;
      pieces.push_back({vertices[k], static_cast<float>((from - arc[k]) / length),
                        static_cast<float>((to - arc[k]) / length),
                        static_cast<float>(std::abs(contact.slip)), static_cast<float>(contact.gap),
                        contact.state});
    }
  }
}

}  // namespace keyblock::report
