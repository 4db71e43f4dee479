#pragma once
#include <algorithm>
#include <limits>
#include <vector>

#include "cutting/block_system.h"

namespace keyblock::cutting {

/// Shear strength (Pa) of what edges are pieces of, at one normal stress for all: tells weak planes from others. Cleaning leaves the
/// weaker joint as it is. Sets and maps beyond the vectors, outlines and free edges have the standard one.
struct JointStrengths {
  double standard = 0.0;
  std::vector<double> joint_sets{}, trace_maps{};

  /// Of the edge of the domain: infinite.
  [[nodiscard]] double of(EdgeLabel label) const {
    if (label.kind == EdgeKind::domain) return std::numeric_limits<double>::infinity();
    const auto pick = [&](const std::vector<double>& own) {
      const auto k = static_cast<std::size_t>(label.index);
      return k < own.size() ? own[k] : standard;
    };
    if (label.kind == EdgeKind::joint_set) return pick(joint_sets);
    if (label.kind == EdgeKind::trace_map) return pick(trace_maps);
    return standard;
  }
  /// Whether edges that become one are from then on a piece of the first: of two joints the weaker.
  [[nodiscard]] bool is_weaker_joint(EdgeLabel first, EdgeLabel second) const {
    const auto is_joint = [](EdgeLabel label) {
      return label.kind == EdgeKind::joint_set || label.kind == EdgeKind::trace_map;
    };
    return is_joint(first) && is_joint(second) && of(first) < of(second);
  }
  /// Whether no joint is weaker than another.
  [[nodiscard]] bool alike() const {
    const auto same = [&](double strength) { return strength == standard; };
    return std::all_of(joint_sets.begin(), joint_sets.end(), same) &&
           std::all_of(trace_maps.begin(), trace_maps.end(), same);
  }
};

}  // namespace keyblock::cutting
