#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/text.h"
#include "drawing/drawing.h"
#include "drawing/dxf_entities.h"
#include "drawing/layer_name.h"
#include "drawing/refuse.h"

namespace keyblock::drawing {
namespace {

constexpr std::size_t most_vertices = 5'000'000;
constexpr int most_levels = 16;  // of blocks within blocks
constexpr std::size_t longest_layer = 60;

// p' = o + p.x x + p.y y
struct Affine {
  Vec2 x{1.0, 0.0}, y{0.0, 1.0}, o;

  Vec2 operator()(Vec2 p) const { return o + p.x * x + p.y * y; }
  [[nodiscard]] Affine after(const Affine& first) const {
    return {p_of(first.x), p_of(first.y), (*this)(first.o)};
  }

 private:
  [[nodiscard]] Vec2 p_of(Vec2 direction) const { return direction.x * x + direction.y * y; }
};

// Records of a block, or of the drawing itself.
struct Contents {
  Vec2 base;
  std::span<const Record> records;
};

// m, by the number of $INSUNITS; 0: none.
std::optional<double> unit_of(int number) {
  constexpr double inch = 0.0254;
  constexpr double units[] = {0.0,  inch, 12 * inch,   63360 * inch, 1e-3,      1e-2,
                              1.0,  1e3,  1e-6 * inch, 1e-3 * inch,  36 * inch, 1e-10,
                              1e-9, 1e-6, 0.1,         10.0,         100.0,     1e9};
  if (number <= 0 || number >= static_cast<int>(std::size(units))) return std::nullopt;
  return units[number];
}

class DxfReader {
 public:
  DxfReader(std::string_view text, const std::string& file)
      : all_(read_records(text, file)), numbers_(file), file_(file) {
    drawing_.file = file;
  }

  Drawing read() {
    find_sections();
    entities(model_.records, {}, "", 0);
    return std::move(drawing_);
  }

 private:
  [[noreturn]] void fail(int line, std::string found, std::string expected) const {
    refuse(file_, line, "", std::move(found), std::move(expected));
  }

  // A drawing of entities alone has no section but that.
  void find_sections() {
    const std::span<const Record> records(all_.records);
    for (std::size_t k = 0; k < records.size();) {
      if (records[k].type != "SECTION") {
        ++k;
        continue;
      }
      std::size_t end = k + 1;
      while (end < records.size() && records[end].type != "ENDSEC") ++end;
      const std::string_view name = records[k].text(2);
      const auto inside = records.subspan(k + 1, end - k - 1);
      if (name == "HEADER") read_header(records[k]);
      if (name == "BLOCKS") find_blocks(inside);
      if (name == "ENTITIES") model_.records = inside;
      k = end;
    }
  }

  void read_header(const Record& header) {
    std::string_view variable;
    for (const Pair& pair : header.pairs) {
      if (pair.code == 9) variable = pair.value;
      if (pair.code == 70 && variable == "$INSUNITS")
        drawing_.unit = unit_of(static_cast<int>(std::clamp(numbers_.number(pair), -1.0, 100.0)));
    }
  }

  void find_blocks(std::span<const Record> records) {
    for (std::size_t k = 0; k < records.size();) {
      if (records[k].type != "BLOCK") {
        ++k;
        continue;
      }
      std::size_t end = k + 1;
      while (end < records.size() && records[end].type != "ENDBLK") ++end;
      blocks_[capitals(records[k].text(2))] = {numbers_.point(records[k], 10),
                                               records.subspan(k + 1, end - k - 1)};
      k = end;
    }
  }

  // `layer`: that of the reference, which what is on layer 0 of a block takes; empty in the drawing itself.
  void entities(std::span<const Record> records, const Affine& place, const std::string& layer, int level) {
    for (std::size_t k = 0; k < records.size();) {
      const Record& record = records[k];
      std::size_t next = k + 1;
      if (record.type == "POLYLINE") {
        while (next < records.size() && records[next].type == "VERTEX") ++next;
      }
      entity(record, records.subspan(k + 1, next - k - 1), place, layer, level);
      k = next;
    }
  }

  void entity(const Record& record, std::span<const Record> vertices, const Affine& place,
              const std::string& layer, int level) {
    if (record.type == "SEQEND" || record.type == "VIEWPORT") return;
    const std::string own = layer_of(record, layer);
    std::string reason;
    if (numbers_.integer(record, 67, 0) == 1) {
      skip(record, own, "in paper space");
    } else if (record.type == "INSERT") {
      reference(record, place, own, level);
    } else if (auto shape = record.type == "POLYLINE" ? shape_of_polyline(record, vertices, numbers_, reason)
                                                      : shape_of(record, numbers_, reason)) {
      add(record, own, *shape, place);
    } else {
      skip(record, own, reason);
    }
  }

  std::string layer_of(const Record& record, const std::string& of_reference) const {
    std::string_view name = record.text(8);
    if (name.empty()) name = "0";
    if (name == "0" && !of_reference.empty()) return of_reference;
    return printable(name, longest_layer);
  }

  void skip(const Record& record, const std::string& layer, const std::string& reason) {
    std::string entity = printable(record.type, longest_layer);
    if (!reason.empty()) entity += " " + reason;
    const auto [place, is_new] = places_of_skipped_.try_emplace({entity, layer}, drawing_.skipped.size());
    if (is_new) drawing_.skipped.push_back({entity, layer, 0, record.line});
    ++drawing_.skipped[place->second].count;
  }

  void add(const Record& record, const std::string& layer, const EntityShape& shape, const Affine& place) {
    DrawnLine line{{}, shape.closed, layer, std::string(record.type), record.line};
    for (const Vec2 p : shape.vertices) {
      const Vec2 q = place(p);
      if (!std::isfinite(q.x) || !std::isfinite(q.y))
        fail(record.line, fmt::format("a {} whose coordinates are too large", line.entity),
             "finite coordinates");
      if (line.vertices.empty() || !(q == line.vertices.back())) line.vertices.push_back(q);
    }
    if (line.vertices.size() > 3 && line.vertices.front() == line.vertices.back()) line.closed = true;
    if (line.closed && line.vertices.size() > 1 && line.vertices.front() == line.vertices.back())
      line.vertices.pop_back();
    vertices_ += line.vertices.size();
    if (vertices_ > most_vertices)
      fail(record.line, fmt::format("more than {} vertices", most_vertices), "a drawing of fewer");
    if (layers_.insert(capitals(layer)).second) drawing_.layers.push_back(layer);
    drawing_.lines.push_back(std::move(line));
  }

  void reference(const Record& record, const Affine& place, const std::string& layer, int level) {
    const auto block = blocks_.find(capitals(record.text(2)));
    const Plane plane = plane_of(record, numbers_);
    if (block == blocks_.end() || plane == Plane::tilted) {
      skip(record, layer, block == blocks_.end() ? "of a block that is not there" : "in a tilted plane");
      return;
    }
    if (level == most_levels)
      fail(record.line, fmt::format("a block within blocks, {} levels deep", most_levels),
           "blocks that do not hold themselves");
    const double angle = numbers_.number(record, 50, 0.0) * std::numbers::pi / 180.0;
    const Vec2 along{std::cos(angle), std::sin(angle)};
    const double scale_x = numbers_.number(record, 41, 1.0), scale_y = numbers_.number(record, 42, 1.0);
    const Affine mirror{{plane == Plane::from_below ? -1.0 : 1.0, 0.0}, {0.0, 1.0}, {}};
    const Affine to_base{{1.0, 0.0}, {0.0, 1.0}, -block->second.base};
    for (const Vec2 step : steps_of_array(record)) {
      const Affine turned{scale_x * along, scale_y * perpendicular(along),
                          numbers_.point(record, 10) + step.x * along + step.y * perpendicular(along)};
      entities(block->second.records, place.after(mirror).after(turned).after(to_base), layer, level + 1);
    }
  }

  // A reference may stand for columns and rows of its block.
  std::vector<Vec2> steps_of_array(const Record& record) {
    const int columns = std::max(1, numbers_.integer(record, 70, 1)),
              rows = std::max(1, numbers_.integer(record, 71, 1));
    references_ += static_cast<double>(columns) * rows;
    constexpr double most_references = 1e5;
    if (references_ > most_references)
      fail(record.line, fmt::format("more than {:.0f} references of blocks", most_references),
           "a drawing of fewer");
    const Vec2 step{numbers_.number(record, 44, 0.0), numbers_.number(record, 45, 0.0)};
    std::vector<Vec2> steps;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) steps.push_back({column * step.x, row * step.y});
    }
    return steps;
  }

  Records all_;
  Numbers numbers_;
  const std::string& file_;
  Drawing drawing_;
  Contents model_;
  std::map<std::string, Contents> blocks_;  ///< by name in capitals
  std::map<std::pair<std::string, std::string>, std::size_t> places_of_skipped_;
  std::set<std::string> layers_;  ///< in capitals
  std::size_t vertices_ = 0;
  double references_ = 0.0;
};

}  // namespace

std::string capitals(std::string_view name) {
  std::string out(name);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

Drawing read_dxf(std::string_view text, const std::string& file) {
  return DxfReader(text, file).read();
}

}  // namespace keyblock::drawing
