#include "cutting/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <string_view>
#include <tuple>

#include "core/index.h"
#include "core/svg.h"
#include "core/xml_text.h"

namespace keyblock::cutting {

namespace {

constexpr double page_width = 1000.0;
constexpr double margin = 30.0;
constexpr double legend_row = 24.0;
constexpr int font_size = 15;
constexpr std::string_view rock_fill = "#f5f2ea";
constexpr std::string_view removed_colour = "#c9c6bf";
constexpr std::string_view ink = "#222222";

/// Colours that the colour-blind can tell apart (Okabe & Ito 2008), without black and yellow.
std::string_view joint_colour(std::size_t k) {
  constexpr std::array<std::string_view, 6> colours{"#0072b2", "#d55e00", "#009e73",
                                                    "#cc79a7", "#e69f00", "#56b4e9"};
  return colours[k % colours.size()];
}

/// One line of the legend, and how its lines are drawn.
struct Style {
  std::string name;
  std::string_view colour;
  double width = 1.0;
};

struct LabelledEdge {
  Vec2 a, b;
  EdgeLabel label;
};

/// Of two blocks that share an edge, the first has it.
std::vector<LabelledEdge> edges_drawn_once(const BlockSystem& system) {
  std::vector<LabelledEdge> edges;
  for (const CutBlock& block : system.blocks) {
    for (std::size_t r = 0; r < block.labels.size(); ++r) {
      const Ring& ring = block.polygon.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k)
        edges.push_back({ring[k], ring[(k + 1) % ring.size()], block.labels[r][k]});
    }
  }
  using Ends = std::array<double, 4>;
  std::vector<std::pair<Ends, std::size_t>> by_ends;
  by_ends.reserve(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto [a, b, label] = edges[k];
    by_ends.emplace_back(std::min(Ends{a.x, a.y, b.x, b.y}, Ends{b.x, b.y, a.x, a.y}), k);
  }
  std::sort(by_ends.begin(), by_ends.end());
  std::vector<std::uint8_t> drawn(edges.size(), 1);
  for (std::size_t i = 1; i < by_ends.size(); ++i) {
    if (by_ends[i].first == by_ends[i - 1].first) drawn[by_ends[i].second] = 0;
  }
  std::vector<LabelledEdge> once;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (drawn[k] != 0) once.push_back(edges[k]);
  }
  return once;
}

class Picture {
 public:
  Picture(const BlockSystem& system, const PictureNames& names) : system_(system), names_(names) {
    Box box;
    std::size_t edges = 0;
    for (const CutBlock& block : system.blocks) {
      box.add(bounds(block.polygon));
      for (const auto& ring : block.labels) edges += ring.size();
    }
    if (system.blocks.empty()) box = {{0.0, 0.0}, {1.0, 1.0}};
    box_ = box;
    scale_ = (page_width - 2.0 * margin) / std::max(box.size().x, 0.5 * box.size().y);
    left_ = 0.5 * (page_width - scale_ * box.size().x);
    bottom_ = margin + scale_ * box.size().y;
    // Thinner lines for smaller blocks.
    const double spacing = scale_ * std::sqrt(box.size().x * box.size().y / static_cast<double>(edges + 1));
    line_ = std::clamp(0.12 * spacing, 0.25, 1.6);
    // On the high side: an edge is drawn at most twice, as a side of its block and as a joint.
    constexpr std::size_t bytes_per_edge = 64, bytes_of_legend = 4096;
    body_.reserve(bytes_of_legend + bytes_per_edge * edges);
  }

  std::string draw(const std::vector<rockmass::Trace>& traces, const std::vector<Ring>& excavations,
                   const std::vector<BlockPaint>& paint) {
    write("<g fill=\"{}\" fill-rule=\"evenodd\">\n", rock_fill);
    fills(false);
    write("</g>\n<g fill=\"#ffffff\" fill-rule=\"evenodd\">\n");
    fills(true);
    write("</g>\n");
    for (const BlockPaint& some : paint) painted(some);
    removed(traces);
    joints();
    outlines(excavations);
    const double height = legend();
    body_ += svg_end;
    body_.insert(0, svg_begin(page_width, height, font_size));
    return std::move(body_);
  }

 private:
  template <typename... T>
  void write(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(body_), format, std::forward<T>(values)...);
  }

  void point(char command, Vec2 p) {
    svg_point(body_, command, left_ + scale_ * (p.x - box_.min.x), bottom_ - scale_ * (p.y - box_.min.y));
  }

  void ring_path(const Ring& ring, Vec2 shift) {
    for (std::size_t k = 0; k < ring.size(); ++k) point(k == 0 ? 'M' : 'L', ring[k] + shift);
    body_ += 'Z';
  }

  void fill(const CutBlock& block) {
    body_ += "<path d=\"";
    for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) ring_path(block.polygon.ring(r), {});
    body_ += "\"/>\n";
  }

  void fills(bool excavated) {
    for (const CutBlock& block : system_.blocks) {
      if (block.excavations.empty() != excavated) fill(block);
    }
  }

  void painted(const BlockPaint& paint) {
    constexpr double legend_width = 12.0;
    if (paint.blocks.empty()) return;
    write("<g fill=\"{}\" fill-rule=\"evenodd\">\n", paint.colour);
    for (const int b : paint.blocks) fill(system_.blocks[at(b)]);
    write("</g>\n");
    legend_.push_back({paint.name, paint.colour, legend_width});
  }

  void removed(const std::vector<rockmass::Trace>& traces) {
    if (traces.empty()) return;
    write("<clipPath id=\"domain\"><path d=\"");
    for (const CutBlock& block : system_.blocks) ring_path(block.polygon.outer, {});
    write(
        "\"/></clipPath>\n<path clip-path=\"url(#domain)\" fill=\"none\" stroke=\"{}\" "
        "stroke-width=\"{:.2f}\" d=\"",
        removed_colour, line_);
    for (const rockmass::Trace& trace : traces) {
      point('M', trace.a - system_.origin);
      point('L', trace.b - system_.origin);
    }
    write("\"/>\n");
    legend_.push_back({"bounds no block", removed_colour, line_});
  }

  /// Edges by label, each side of a joint drawn once.
  void joints() {
    using Key = std::tuple<EdgeKind, int>;
    std::map<Key, std::vector<std::array<Vec2, 2>>> edges;
    for (const auto& [a, b, label] : edges_drawn_once(system_))
      edges[{label.kind, label.kind == EdgeKind::domain ? 0 : label.index}].push_back({a, b});
    std::vector<Style> styles;
    for (const auto& [key, list] : edges) {
      const auto [kind, index] = key;
      if (kind == EdgeKind::excavation) continue;
      const Style style = style_of(kind, static_cast<std::size_t>(index));
      write("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linecap=\"round\" d=\"",
            style.colour, style.width);
      for (const auto& [a, b] : list) {
        point('M', a);
        point('L', b);
      }
      write("\"/>\n");
      if (kind != EdgeKind::domain) styles.push_back(style);
    }
    legend_.insert(legend_.begin(), styles.begin(), styles.end());
  }

  [[nodiscard]] Style style_of(EdgeKind kind, std::size_t index) const {
    const auto name = [&](const std::vector<std::string>& list, std::string_view word) {
      return index < list.size() ? list[index] : fmt::format("{} {}", word, index + 1);
    };
    switch (kind) {
      case EdgeKind::joint_set:
        return {name(names_.joint_sets, "joint set"), joint_colour(index), line_};
      case EdgeKind::trace_map:
        return {name(names_.trace_maps, "trace map"), joint_colour(names_.joint_sets.size() + index), line_};
      case EdgeKind::excavation:
        return {name(names_.excavations, "excavation"), ink, 2.4};
      default:
        return {"edge", ink, std::max(1.0, line_)};
    }
  }

  void outlines(const std::vector<Ring>& excavations) {
    for (std::size_t k = 0; k < excavations.size(); ++k) {
      const Style style = style_of(EdgeKind::excavation, k);
      write("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linejoin=\"round\" d=\"",
            style.colour, style.width);
      ring_path(excavations[k], -system_.origin);
      write("\"/>\n");
      legend_.push_back(style);
    }
  }

  /// Scale bar and legend under the picture; returns the height of the page.
  double legend() {
    const double top = bottom_ + 34.0;
    const double rough = 0.2 * box_.size().x;
    double bar = std::pow(10.0, std::floor(std::log10(rough)));
    bar *= rough >= 5.0 * bar ? 5.0 : rough >= 2.0 * bar ? 2.0 : 1.0;
    const double from = left_, to = left_ + scale_ * bar;
    write("<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" d=\"M{:.2f} {:.2f}v8H{:.2f}v-8\"/>\n", ink,
          from, top - 8.0, to);
    write("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"middle\" fill=\"{}\">{:g} m</text>\n",
          0.5 * (from + to), top + 17.0, ink, bar);
    const double first = std::max(to + 50.0, 280.0);
    double x = first, y = top;
    for (const Style& style : legend_) {
      // 8 units are a generous mean width of a letter at this size.
      const double width = 60.0 + 8.0 * static_cast<double>(style.name.size());
      if (x > first && x + width > page_width - margin) {
        x = first;
        y += legend_row;
      }
      write("<path stroke=\"{}\" stroke-width=\"{:.2f}\" d=\"M{:.2f} {:.2f}h28\"/>\n", style.colour,
            std::max(1.5, style.width), x, y - 1.0);
      write("<text x=\"{:.2f}\" y=\"{:.2f}\" fill=\"{}\">{}</text>\n", x + 35.0, y + 4.0, ink,
            xml_text(style.name));
      x += width;
    }
    return std::max(y, top + 17.0) + margin;
  }

  const BlockSystem& system_;
  const PictureNames& names_;
  Box box_;
  double scale_ = 1.0, left_ = 0.0, bottom_ = 0.0;
  double line_ = 1.0;  ///< width of joints
  std::string body_;
  std::vector<Style> legend_;
};

}  // namespace

std::string draw_svg(const BlockSystem& system, const std::vector<rockmass::Trace>& traces,
                     const std::vector<Ring>& excavations, const PictureNames& names,
                     const std::vector<BlockPaint>& paint) {
  return Picture(system, names).draw(traces, excavations, paint);
}

}  // namespace keyblock::cutting
