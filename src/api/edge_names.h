#pragma once
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
};

}  // namespace keyblock::api
