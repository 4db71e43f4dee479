#pragma once
#include <string>
#include <vector>

#include "cutting/block_system.h"

namespace keyblock::cutting {

/// The joint set, trace map or excavation that an edge is a piece of; empty for other edges, and where it has no name.
inline std::string edge_name(EdgeLabel label, const std::vector<std::string>& joint_sets,
                             const std::vector<std::string>& trace_maps,
                             const std::vector<std::string>& excavations) {
  const auto name_in = [&](const std::vector<std::string>& names) {
    const auto k = static_cast<std::size_t>(label.index);
    return k < names.size() ? names[k] : std::string();
  };
  if (label.kind == EdgeKind::joint_set) return name_in(joint_sets);
  if (label.kind == EdgeKind::trace_map) return name_in(trace_maps);
  if (label.kind == EdgeKind::excavation) return name_in(excavations);
  return {};
}

}  // namespace keyblock::cutting
