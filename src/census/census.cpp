#include "census/census.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace keyblock::census {
namespace {

using cutting::EdgeKind;
using cutting::EdgeLabel;

double distance_to(const Face& face, Vec2 p) {
  const Vec2 along = face.to - face.from;
  const double share = std::clamp(dot(p - face.from, along) / squared_norm(along), 0.0, 1.0);
  return norm(p - lerp(face.from, face.to, share));
}

/// The rock at hand: what is still there, and how it holds.
class Rock {
 public:
  explicit Rock(const Input& input)
      : input_(input), faces_(find_faces(input.system)), accuracy_(touching_distance(input.system)) {
    for (const cutting::CutBlock& block : input.system.blocks) present_.push_back(block.excavations.empty());
    find_wall();
  }

  [[nodiscard]] const std::vector<Face>& wall() const { return wall_; }
  [[nodiscard]] bool is_exposed(int block) const {
    return present_[at(block)] != 0 && input_.fixed[at(block)] == 0 &&
           std::any_of(faces_[at(block)].begin(), faces_[at(block)].end(),
                       [&](const Face& face) { return is_free(face); });
  }
  void take_out(int block) { present_[at(block)] = 0; }

  [[nodiscard]] KeyBlock judge(int block) const {
    KeyBlock key;
    const Polygon& polygon = input_.system.blocks[at(block)].polygon;
    key.block = block;
    key.centroid = centroid(polygon);
    key.area = area(polygon);
    key.depth = depth(polygon);
    const double mass = input_.density[at(block)] * key.area, g = norm(input_.gravity);
    key.weight = mass * g;
    const Vec2 resultant = mass * (input_.gravity + g * input_.seismic);
    std::vector<HoldingFace> holding;
    std::vector<EdgeLabel> labels;
    for (const Face& face : faces_[at(block)]) {
      if (is_free(face)) continue;
      const FaceStrength strength = strength_of(face);
      holding.push_back(
          {face.out(), face.length, face.edge_length(), strength.friction_coefficient, strength.cohesion});
      labels.push_back(face.label);
    }
    key.removal = find_removal(holding, resultant, accuracy_);
    key.force = key.removal.force_for(input_.wanted_factor);
    for (const std::size_t f : key.removal.sliding) {
      if (std::find(key.joints.begin(), key.joints.end(), labels[f]) == key.joints.end())
        key.joints.push_back(labels[f]);
    }
    return key;
  }

 private:
  void find_wall() {
    std::vector<Face> open;
    for (std::size_t b = 0; b < faces_.size(); ++b) {
      if (present_[b] == 0) continue;
      for (const Face& face : faces_[b]) {
        if (!is_free(face)) continue;
        (face.beyond >= 0 ? wall_ : open).push_back(face);
      }
    }
    if (wall_.empty()) wall_ = std::move(open);
  }

  [[nodiscard]] bool is_free(const Face& face) const {
    if (face.beyond >= 0) return present_[at(face.beyond)] == 0;
    if (face.beyond == nothing) return true;
    const bool is_top = face.out().y > std::sqrt(0.5);
    return is_top ? !input_.rock_above : !input_.rock_around;
  }

  [[nodiscard]] FaceStrength strength_of(const Face& face) const {
    if (face.beyond == edge_of_domain) return input_.frame;
    const auto pick = [&](const std::vector<FaceStrength>& own,
                          const std::vector<std::vector<FaceStrength>>& traces) {
      const std::size_t k = at(face.label.index);
      if (k < traces.size() && face.label.trace >= 0 && at(face.label.trace) < traces[k].size())
        return traces[k][at(face.label.trace)];
      return k < own.size() ? own[k] : input_.standard;
    };
    if (face.label.kind == EdgeKind::joint_set) return pick(input_.joint_sets, input_.joint_set_traces);
    if (face.label.kind == EdgeKind::trace_map) return pick(input_.trace_maps, input_.trace_map_traces);
    return input_.standard;
  }

  [[nodiscard]] double depth(const Polygon& polygon) const {
    double deepest = 0.0;
    for (const Vec2 corner : polygon.outer) {
      double nearest = HUGE_VAL;
      for (const Face& face : wall_) nearest = std::min(nearest, distance_to(face, corner));
      deepest = std::max(deepest, nearest);
    }
    return deepest;
  }

  const Input& input_;
  std::vector<std::vector<Face>> faces_;
  double accuracy_;  ///< m, to which corners are known
  std::vector<std::uint8_t> present_;
  std::vector<Face> wall_;
};

}  // namespace

Census take_census(const Input& input) {
  Census census;
  Rock rock(input);
  for (const Face& face : rock.wall()) census.wall += face.length;
  if (rock.wall().empty()) return census;
  const auto blocks = static_cast<int>(input.system.blocks.size());
  std::vector<KeyBlock> staying;
  for (bool moved = true; moved;) {
    staying.clear();
    const std::size_t before = census.blocks.size();
    for (int b = 0; b < blocks; ++b) {
      if (!rock.is_exposed(b)) continue;
      KeyBlock key = rock.judge(b);
      if (key.removal.moves()) {
        key.layer = census.layers + 1;
        census.blocks.push_back(std::move(key));
      } else {
        staying.push_back(std::move(key));
      }
    }
    moved = census.blocks.size() > before;
    if (moved) ++census.layers;
    for (std::size_t k = before; k < census.blocks.size(); ++k) rock.take_out(census.blocks[k].block);
  }
  census.blocks.insert(census.blocks.end(), staying.begin(), staying.end());
  return census;
}

Totals totals(const Census& census) {
  Totals sum;
  for (const KeyBlock& key : census.blocks) {
    ++sum.by_mode[static_cast<std::size_t>(key.removal.mode)];
    sum.force += key.force;
    if (!key.moves()) {
      sum.supported += key.force > 0.0;
      continue;
    }
    ++sum.moving;
    sum.area += key.area;
    if (key.layer == 1) sum.first_layer_area += key.area;
    sum.weight += key.weight;
    sum.deepest = std::max(sum.deepest, key.depth);
    if (key.area <= sum.largest_area) continue;
    sum.largest_area = key.area;
    sum.largest_depth = key.depth;
  }
  return sum;
}

}  // namespace keyblock::census
