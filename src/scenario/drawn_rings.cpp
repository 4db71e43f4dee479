#include "scenario/drawn_rings.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/read_file.h"
#include "scenario/excavated_blocks.h"
#include "scenario/polygon_checks.h"

namespace keyblock::scenario {
namespace {

// Ends of a line nearer than this share of its length are one point: they were drawn by eye, or computed as an angle.
constexpr double same_point = 1e-6;

Diagnostic mistake_at(const DrawnRing& ring, std::string found, std::string expected, std::string hint = {}) {
  return {ring.where, ring.entity, std::move(found), std::move(expected), std::move(hint)};
}

// Closes a line whose ends meet. The gap between them otherwise.
double close(drawing::DrawnLine& line) {
  if (line.closed) return 0.0;
  const double gap = norm(line.vertices.back() - line.vertices.front());
  if (gap > same_point * perimeter({line.vertices, {}})) return gap;
  if (line.vertices.size() > 1) line.vertices.pop_back();
  return 0.0;
}

}  // namespace

std::vector<DrawnRing> read_rings(const std::filesystem::path& file, const rockmass::MapChoice& choice,
                                  Mistakes& mistakes, std::string& skipped) {
  std::vector<DrawnRing> rings;
  try {
    const drawing::Drawing drawn = drawing::read_drawing(read_file(file), file.string());
    std::vector<drawing::DrawnLine> lines = drawing::lines_on(drawn, choice.layers);
    drawing::Placement placement = choice.placement;
    placement.scale = drawing::scale_of(drawn, lines, placement);
    for (drawing::DrawnLine& line : lines) {
      DrawnRing ring;
      ring.layer = line.layer;
      const bool on_layer = !line.layer.empty();
      ring.where = {file.string(), on_layer ? line.line : 0, on_layer ? 1 : 0};
      ring.entity =
          line.entity + (on_layer ? " on layer " + line.layer : fmt::format(" of record {}", line.line));
      const double gap = close(line);
      if (gap > 0.0) {
        mistakes.add(mistake_at(
            ring, fmt::format("an open line, whose ends are {:.4g} m apart", gap * *placement.scale),
            "closed lines", "join lines to closed polylines, or choose other layers"));
        continue;
      }
      Polygon polygon;
      for (const Vec2 p : line.vertices) polygon.outer.push_back(placement(p));
      const auto fault =
          polygon.outer.size() < 3 ? PolygonFault{false, "a line without area"} : orient_and_check(polygon);
      if (fault) {
        mistakes.add(mistake_at(ring, fault->text, "a ring that encloses an area and does not cross itself"));
        continue;
      }
      ring.ring = std::move(polygon.outer);
      rings.push_back(std::move(ring));
    }
    skipped = drawing::skipped_words(drawn, choice.layers);
  } catch (const InputError& error) {
    mistakes.add(error.diagnostics());
  }
  return rings;
}

void check_overlaps(const std::vector<DrawnRing>& rings, Mistakes& mistakes) {
  std::vector<Box> boxes;
  for (const DrawnRing& ring : rings) boxes.push_back(bounds(Polygon{ring.ring, {}}));
  std::vector<std::size_t> order(rings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return boxes[k].min.x; });
  for (std::size_t i = 0; i < order.size() && !mistakes.full(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].min.x <= boxes[order[i]].max.x; ++j) {
      if (!boxes[order[i]].overlaps(boxes[order[j]])) continue;
      const auto [first, second] = std::minmax(order[i], order[j]);
      const DrawnRing &a = rings[first], &b = rings[second];
      const bool a_is_smaller = signed_area(a.ring) < signed_area(b.ring);
      const Overlay over = overlay({a_is_smaller ? a.ring : b.ring, {}}, a_is_smaller ? b.ring : a.ring);
      if (over.place == Place::outside) continue;
      mistakes.add(
          mistake_at(b,
                     fmt::format("a block that overlaps the {} of line {} by {:.3g} % of the smaller one",
                                 a.entity, a.where.line, 100.0 * over.share),
                     "blocks beside each other"));
    }
  }
}

}  // namespace keyblock::scenario
