#include "results/joint_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace keyblock::results {

using record::ContactRecord;

namespace {

/// Sine of the largest angle between two pieces of one straight edge.
constexpr double straight_sine = 1e-6;

/// Sine of the largest angle between an edge of one block and the edge of the other that it lies on.
constexpr double along_sine = 0.3;

}  // namespace

JointLocator::JointLocator(const record::ModelRecord& model) : model_(model), chains_(model.blocks.size()) {
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

Vec2 JointLocator::position(std::uint32_t vertex, Displacement displacement) const {
  const std::array<float, 2>& u = displacement[vertex];
  return model_.vertices[vertex] + Vec2{double{u[0]}, double{u[1]}};
}

JointLocator::Foot JointLocator::foot_of(const ContactRecord& contact, Displacement displacement) const {
  Foot best;
  double best_score = std::numeric_limits<double>::infinity();
  for (const Chain& chain : chains_[static_cast<std::size_t>(contact.block_b)]) {
    for (std::size_t k = 0; k + 1 < chain.vertices.size(); ++k) {
      const Vec2 from = position(chain.vertices[k], displacement);
      const Vec2 along = position(chain.vertices[k + 1], displacement) - from;
      const double length = norm(along);
      if (!(length > 0.0)) continue;
      const double share = std::clamp(dot(contact.position - from, along) / (length * length), 0.0, 1.0);
      const double distance = norm(contact.position - (from + share * along));
      const double facing = dot(contact.normal, -perpendicular(along)) / length;
      const double score = distance + contact.length * (1.0 - facing);
      if (score < best_score) {
        best = {&chain, k, share};
        best_score = score;
      }
    }
  }
  return best;
}

double JointLocator::side_of(const ContactRecord& contact, Vec2 along, Displacement displacement) const {
  const auto& start = model_.blocks[static_cast<std::size_t>(contact.block_a)].ring_start;
  double nearest = std::numeric_limits<double>::infinity();
  double side = 0.0;
  for (std::size_t r = 0; r + 1 < start.size(); ++r) {
    const auto begin = static_cast<std::uint32_t>(start[r]);
    const auto count = static_cast<std::uint32_t>(start[r + 1]) - begin;
    for (std::uint32_t k = 0; k < count; ++k) {
      const Vec2 vertex = position(begin + k, displacement);
      const double distance = norm(vertex - contact.position);
      if (distance >= nearest) continue;
      nearest = distance;
      side = 0.0;
      for (const std::uint32_t neighbour : {(k + 1) % count, (k + count - 1) % count}) {
        const Vec2 edge = position(begin + neighbour, displacement) - vertex;
        if (std::abs(cross(along, edge)) < along_sine * norm(edge))
          side += dot(along, edge) > 0.0 ? 1.0 : -1.0;
      }
    }
  }
  return std::clamp(side, -1.0, 1.0);
}

JointLocator::Stretch JointLocator::stretch(const ContactRecord& contact, Displacement displacement) const {
  Stretch stretch;
  const Foot foot = foot_of(contact, displacement);
  if (foot.chain == nullptr) return stretch;
  const auto& vertices = foot.chain->vertices;
  std::vector<double> arc(vertices.size(), 0.0);
  for (std::size_t k = 0; k + 1 < vertices.size(); ++k)
    arc[k + 1] = arc[k] + norm(position(vertices[k + 1], displacement) - position(vertices[k], displacement));
  const Vec2 from = position(vertices[foot.piece], displacement);
  const Vec2 to = position(vertices[foot.piece + 1], displacement);
  const Vec2 along = normalized(to - from);
  stretch.beyond = dot(contact.position - lerp(from, to, foot.share), along);
  stretch.contact = std::lerp(arc[foot.piece], arc[foot.piece + 1], foot.share);
  const double first = stretch.contact - 0.5 * (1.0 - side_of(contact, along, displacement)) * contact.length;
  stretch.begin = std::clamp(first, 0.0, std::max(0.0, arc.back() - contact.length));
  stretch.end = std::min(arc.back(), stretch.begin + contact.length);
  stretch.chain = foot.chain;
  stretch.arc = std::move(arc);
  return stretch;
}

std::pair<double, double> JointLocator::reach(const ContactRecord& contact, Displacement displacement) const {
  const Stretch found = stretch(contact, displacement);
  const double contact_at = found.contact + found.beyond;
  return {found.begin - contact_at, found.end - contact_at};
}

void JointLocator::locate(std::span<const ContactRecord> contacts, Displacement displacement,
                          std::vector<JointPiece>& pieces) const {
  for (const ContactRecord& contact : contacts) {
    const Stretch found = stretch(contact, displacement);
    if (found.chain == nullptr) continue;
    const auto& [vertices] = *found.chain;
    const std::vector<double>& arc = found.arc;
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
      const double length = arc[k + 1] - arc[k];
      const double from = std::max(found.begin, arc[k]);
      const double to = std::min(found.end, arc[k + 1]);
      if (!(to > from)) continue;
      pieces.push_back({vertices[k], static_cast<float>((from - arc[k]) / length),
                        static_cast<float>((to - arc[k]) / length), static_cast<float>(contact.slip()),
                        static_cast<float>(contact.gap), contact.state,
                        static_cast<float>(1.0 - contact.strength_left),
                        static_cast<float>(contact.water_pressure)});
    }
  }
}

}  // namespace keyblock::results
