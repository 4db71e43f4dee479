#include "cutting/geojson.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <array>
#include <iterator>

namespace keyblock::cutting {

std::string_view name_of(EdgeKind kind) {
  constexpr std::array<std::string_view, 5> names{"free", "joint_set", "trace_map", "excavation", "domain"};
  return names[static_cast<std::size_t>(kind)];
}

namespace {

using Output = std::back_insert_iterator<std::string>;

void write_ring(Output out, const Ring& ring, Vec2 origin) {
  fmt::format_to(out, "[");
  for (std::size_t k = 0; k <= ring.size(); ++k) {
    const Vec2 p = ring[k % ring.size()] + origin;
    fmt::format_to(out, FMT_COMPILE("{}[{},{}]"), k > 0 ? "," : "", p.x, p.y);
  }
  fmt::format_to(out, "]");
}

void write_labels(Output out, const std::vector<EdgeLabel>& labels) {
  fmt::format_to(out, "[");
  for (std::size_t k = 0; k < labels.size(); ++k) {
    fmt::format_to(out, FMT_COMPILE("{}[\"{}\",{}]"), k > 0 ? "," : "", name_of(labels[k].kind),
                   labels[k].index);
  }
  fmt::format_to(out, "]");
}

/// About the bytes of the text, on the high side; what is not written to takes no memory.
std::size_t expected_size(const BlockSystem& system) {
  constexpr std::size_t per_block = 160, per_vertex = 64;
  std::size_t vertices = 0;
  for (const CutBlock& block : system.blocks) {
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) vertices += block.polygon.ring(r).size() + 1;
  }
  return per_block * (system.blocks.size() + 1) + per_vertex * vertices;
}

}  // namespace

std::string to_geojson(const BlockSystem& system) {
  std::string text;
  text.reserve(expected_size(system));
  text = "{\"type\":\"FeatureCollection\",\"features\":[";
  const Output out = std::back_inserter(text);
  for (std::size_t id = 0; id < system.blocks.size(); ++id) {
    const CutBlock& block = system.blocks[id];
    fmt::format_to(
        out,
        "{}\n{{\"type\":\"Feature\",\"properties\":{{\"id\":{},\"area\":{},\"excavations\":[{}],\"edges\":[",
        id > 0 ? "," : "", id, area(block.polygon), fmt::join(block.excavations, ","));
    for (std::size_t r = 0; r < block.labels.size(); ++r) {
      if (r > 0) text += ',';
      write_labels(out, block.labels[r]);
    }
    text += "]},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[";
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) {
      if (r > 0) text += ',';
      write_ring(out, block.polygon.ring(r), system.origin);
    }
    text += "]}}";
  }
  text += "\n]}\n";
  return text;
}

}  // namespace keyblock::cutting
