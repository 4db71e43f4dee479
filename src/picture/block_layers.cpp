#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/index.h"
#include "picture/layers.h"

namespace keyblock::picture {
namespace {

using cutting::EdgeKind;

void add_block_rings(std::string& path, const Canvas& canvas, std::size_t block) {
  const auto& start = canvas.run.model.blocks[block].ring_start;
  for (std::size_t r = 0; r + 1 < start.size(); ++r) {
    for (int v = start[r]; v < start[r + 1]; ++v)
      canvas.view.point(path, v == start[r] ? 'M' : 'L', canvas.place.vertex(at(v)));
    path += 'Z';
  }
}

// Thin where blocks are small.
double edge_width(const Canvas& canvas) {
  return 0.3 + 0.6 * std::min(1.0, canvas.block_size * canvas.view.scale / 25.0);
}

std::string path_of(const std::string& d, std::string_view attributes) {
  return d.empty() ? d : fmt::format("<path {} d=\"{}\"/>\n", attributes, d);
}

std::string lines_of(const std::string& d, std::string_view color, double width) {
  return path_of(
      d, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linecap=\"round\"", color,
                     width));
}

// Of every display vertex, the next of its ring.
std::vector<std::size_t> next_vertices(const record::ModelRecord& model) {
  std::vector<std::size_t> next(model.vertices.size());
  for (const auto& block : model.blocks) {
    for (std::size_t r = 0; r + 1 < block.ring_start.size(); ++r) {
      const int first = block.ring_start[r], end = block.ring_start[r + 1];
      for (int v = first; v < end; ++v) next[at(v)] = at(v + 1 < end ? v + 1 : first);
    }
  }
  return next;
}

/// Draws stretches of joints. The edge of the domain is none: a frame without friction would seem to slide all round.
class PieceLines {
 public:
  explicit PieceLines(const Canvas& canvas) : canvas_(canvas), next_(next_vertices(canvas.run.model)) {}

  [[nodiscard]] bool is_joint(const results::JointPiece& piece) const {
    return canvas_.run.model.edge_label[piece.vertex].kind != EdgeKind::domain && piece.to > piece.from;
  }
  void add(std::string& path, const results::JointPiece& piece) const {
    const Vec2 a = canvas_.place.vertex(piece.vertex), b = canvas_.place.vertex(next_[piece.vertex]);
    canvas_.view.line(path, lerp(a, b, double{piece.from}), lerp(a, b, double{piece.to}));
  }

 private:
  const Canvas& canvas_;
  std::vector<std::size_t> next_;
};

struct StateLook {
  const char* name;
  const char* color;
  double width;
};
constexpr StateLook state_looks[] = {
    {"open", "#56b4e9", 1.5}, {"sliding", "#d55e00", 2.5}, {"locked", "#33373b", 1.2}};

// Sets, then maps.
std::size_t place_of_set(const record::ModelRecord& model, cutting::EdgeLabel label) {
  return (label.kind == EdgeKind::trace_map ? model.joint_set_names.size() : 0) + at(label.index);
}

}  // namespace

std::string draw_fixed(const Canvas& canvas) {
  std::string path;
  for (std::size_t b = 0; b < canvas.run.model.blocks.size(); ++b)
    if (canvas.run.model.blocks[b].fixed) add_block_rings(path, canvas, b);
  return path_of(path, fmt::format("fill=\"{}\" stroke=\"#b0b4b8\" stroke-width=\"0.8\"", fixed_color));
}

std::string draw_blocks(const Canvas& canvas, const BlockValues& values, const std::vector<double>& now) {
  std::map<std::string, std::string> paths;  // by colour: rings run so that holes stay empty
  for (std::size_t b = 0; b < now.size(); ++b)
    if (canvas.place.is_drawn(b)) add_block_rings(paths[values.color(now[b])], canvas, b);
  std::string svg = fmt::format(
      "<g stroke=\"{}\" stroke-opacity=\"0.75\" stroke-width=\"{:.2f}\" stroke-linejoin=\"round\">\n",
      joint_color, edge_width(canvas));
  for (const auto& [color, path] : paths) svg += path_of(path, fmt::format("fill=\"{}\"", color));
  return svg + "</g>\n";
}

std::string draw_excavations(const Canvas& canvas) {
  std::string path;
  for (const auto& ring : canvas.run.model.excavation_outlines) {
    for (std::size_t k = 0; k < ring.size(); ++k)
      canvas.view.point(path, k == 0 ? 'M' : 'L', ring[k] - canvas.run.model.origin);
    path += ring.empty() ? "" : "Z";
  }
  return path_of(path,
                 fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-dasharray=\"8 5\"",
                             outline_color));
}

std::string draw_before(const Canvas& canvas) {
  std::string path;
  const auto& model = canvas.run.model;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!canvas.place.is_drawn(b)) continue;
    const auto& start = model.blocks[b].ring_start;
    for (std::size_t r = 0; r + 1 < start.size(); ++r) {
      for (int v = start[r]; v < start[r + 1]; ++v)
        canvas.view.point(path, v == start[r] ? 'M' : 'L', model.vertices[at(v)]);
      path += 'Z';
    }
  }
  return lines_of(path, "#0072b2", 0.8);
}

std::string draw_joint_sets(const Canvas& canvas) {
  const record::ModelRecord& model = canvas.run.model;
  const std::vector<std::size_t> next = next_vertices(model);
  std::map<std::size_t, std::string> paths;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!canvas.place.is_drawn(b)) continue;
    for (int v = model.blocks[b].ring_start.front(); v < model.blocks[b].ring_start.back(); ++v) {
      const cutting::EdgeLabel label = model.edge_label[at(v)];
      if (label.kind != EdgeKind::joint_set && label.kind != EdgeKind::trace_map) continue;
      canvas.view.line(paths[place_of_set(model, label)], canvas.place.vertex(at(v)),
                       canvas.place.vertex(next[at(v)]));
    }
  }
  std::string svg;
  for (const auto& [set, path] : paths) svg += lines_of(path, class_color(set), 1.4);
  return svg;
}

std::vector<NamedColor> set_colors(const record::ModelRecord& model) {
  std::vector<NamedColor> named;
  for (const auto* names : {&model.joint_set_names, &model.trace_map_names})
    for (const std::string& name : *names) named.push_back({name, std::string(class_color(named.size()))});
  return named;
}

std::string draw_states(const Canvas& canvas, const std::vector<results::JointPiece>& pieces) {
  const PieceLines lines(canvas);
  std::string svg;
  // Sliding ones lie on top.
  for (const auto state :
       {record::ContactState::locked, record::ContactState::open, record::ContactState::sliding}) {
    std::string path;
    for (const auto& piece : pieces)
      if (piece.state == state && lines.is_joint(piece)) lines.add(path, piece);
    const StateLook& look = state_looks[static_cast<std::size_t>(state)];
    svg += lines_of(path, look.color, look.width);
  }
  return svg;
}

std::vector<NamedColor> state_colors() {
  std::vector<NamedColor> named;
  for (const StateLook& look : state_looks) named.push_back({look.name, look.color});
  return named;
}

std::string draw_sizes(const Canvas& canvas, const std::vector<results::JointPiece>& pieces, bool slips,
                       const Scale& scale) {
  const PieceLines lines(canvas);
  std::map<int, std::string> paths;  // by shade, the darkest on top
  for (const auto& piece : pieces) {
    const double value = slips ? piece.slip : piece.gap;
    if (value > scale.low && lines.is_joint(piece)) lines.add(paths[shade_at(scale.place(value))], piece);
  }
  std::string svg;
  for (const auto& [k, path] : paths)
    svg += lines_of(path, shade(ColorMap::viridis, k), 1.2 + 3.0 * k / (shades - 1));
  return svg;
}

std::string draw_elements(const Canvas& canvas, double largest_free) {
  std::string halo, svg;
  const auto& model = canvas.run.model;
  for (std::size_t k = 0; k < canvas.place.frame().elements.size(); ++k) {
    const record::ElementState& e = canvas.place.frame().elements[k];
    if (!e.present) continue;
    const double whole = std::isfinite(model.elements[k].limit) ? model.elements[k].limit : largest_free;
    const double share = whole > 0.0 ? std::min(std::abs(e.force) / whole, 1.0) : 0.0;
    std::string path;
    canvas.view.line(path, e.from, e.to);
    halo += lines_of(path, "#ffffff", 4.0 + 4.0 * share);
    svg += lines_of(path, shade(ColorMap::viridis, shade_at(share)), 2.0 + 4.0 * share);
  }
  return halo + svg;
}

}  // namespace keyblock::picture
