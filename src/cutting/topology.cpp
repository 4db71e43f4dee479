#include "cutting/topology.h"

#include "cutting/noding.h"

namespace keyblock::cutting {

NodeCounts count_nodes(const std::vector<rockmass::Trace>& traces, const Ring& area, double snapping) {
  CutInput input;
  input.domain = area;
  input.traces = traces;
  CutTolerances tolerances;
  tolerances.snapping = tolerances.cluster = snapping;
  const PlanarGraph graph = node(make_linework(input, tolerances)).graph;

  NodeCounts counts;
  std::vector<int> degree(graph.points.size(), 0);
  std::vector<bool> on_boundary(graph.points.size(), false);
  for (const GraphEdge& edge : graph.edges) {
    for (const int vertex : {edge.from, edge.to}) {
      if (edge.label.kind == EdgeKind::domain) {
        on_boundary[static_cast<std::size_t>(vertex)] = true;
      } else {
        ++degree[static_cast<std::size_t>(vertex)];
      }
    }
    if (edge.label.kind != EdgeKind::domain) counts.length += graph.length(edge);
  }
  for (std::size_t v = 0; v < degree.size(); ++v) {
    if (on_boundary[v]) {
      counts.boundary += degree[v];
    } else if (degree[v] == 1) {
      ++counts.isolated;
    } else if (degree[v] == 3) {
      ++counts.abutting;
    } else if (degree[v] > 3) {
      ++counts.crossing;
    }
  }
  counts.branches = (counts.isolated + 3 * counts.abutting + 4 * counts.crossing) / 2;
  return counts;
}

}  // namespace keyblock::cutting
