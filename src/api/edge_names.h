#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cutting/edge_name.h"

namespace keyblock::api {

/// What edges are pieces of, as the public headers have it.
struct EdgeNames {
  std::vector<std::string> joint_sets, trace_maps, excavations;

  [[nodiscard]] std::string of(cutting::EdgeLabel label) const {
    if (label.kind == cutting::EdgeKind::domain) return "domain";
    return cutting::edge_name(label, joint_sets, trace_maps, excavations);
  }

  /// Every name once for each kind of edge, and the place of a label's among them.
  [[nodiscard]] std::vector<std::string> all() const {
    std::vector<std::string> names{"", "domain"};
    for (const auto* kind : {&joint_sets, &trace_maps, &excavations})
      names.insert(names.end(), kind->begin(), kind->end());
    return names;
  }
  [[nodiscard]] std::int32_t code_of(cutting::EdgeLabel label) const {
    constexpr std::int32_t fixed = 2;
    const auto size = [](const std::vector<std::string>& names) {
      return static_cast<std::int32_t>(names.size());
    };
    switch (label.kind) {
      case cutting::EdgeKind::free:
        return 0;
      case cutting::EdgeKind::domain:
        return 1;
      case cutting::EdgeKind::joint_set:
        return fixed + label.index;
      case cutting::EdgeKind::trace_map:
        return fixed + size(joint_sets) + label.index;
      case cutting::EdgeKind::excavation:
        return fixed + size(joint_sets) + size(trace_maps) + label.index;
    }
    return 0;
  }
};

}  // namespace keyblock::api
