// What is taken from files of lines, and [[block_map]].
#include <fmt/format.h>

#include <algorithm>

#include "scenario/block_shapes.h"
#include "scenario/drawn_rings.h"
#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

enum class BlockMapShape { file, arch, column, wall };

constexpr Word<BlockMapShape> block_map_shapes[] = {{"file", BlockMapShape::file},
                                                    {"arch", BlockMapShape::arch},
                                                    {"column", BlockMapShape::column},
                                                    {"wall", BlockMapShape::wall}};
constexpr double most_stones = 1e5;
constexpr int most_in_row = 10000;

/// [[block_map]]; the blocks that it makes are what a scenario keeps of it.
struct BlockMapSpec {
  std::string name;
  BlockMapShape shape = BlockMapShape::file;
  std::filesystem::path file;
  rockmass::MapChoice choice;
  ArchShape arch;
  ColumnShape column;
  WallShape wall;
  std::optional<double> top_width;
};

/// Rules of keys that go with one shape.
class ShapeRules {
 public:
  ShapeRules(const TableReader& t, BlockMapShape shape, bool known)
      : documenting_(t.documenting()), shape_(shape), known_(known) {}

  [[nodiscard]] bool has(BlockMapShape shape) const { return !documenting_ && known_ && shape_ == shape; }
  Rule operator()(BlockMapShape shape, Rule rule) const {
    static constexpr std::string_view conditions[] = {"shape = \"file\"", "shape = \"arch\"",
                                                      "shape = \"column\"", "shape = \"wall\""};
    rule.condition = conditions[static_cast<std::size_t>(shape)];
    rule.applies = documenting_ || !known_ || shape_ == shape;
    rule.required = rule.required && (documenting_ || has(shape));
    return rule;
  }
  /// Of a key that two shapes have.
  [[nodiscard]] Rule of_two(BlockMapShape a, BlockMapShape b, std::string_view condition, Rule rule) const {
    rule.condition = condition;
    rule.applies = documenting_ || !known_ || shape_ == a || shape_ == b;
    rule.required = rule.required && (documenting_ || has(a) || has(b));
    return rule;
  }

 private:
  bool documenting_;
  BlockMapShape shape_;
  bool known_;
};

Rule length(std::string_view meaning) {
  return {.meaning = meaning, .unit = "m", .required = true, .above = 0.0, .usual = &usual::spacing};
}

bool read_arch(TableReader& t, ArchShape& arch, const ShapeRules& rules) {
  constexpr auto shape = BlockMapShape::arch;
  bool valid = t.point("springing", arch.springing,
                       rules(shape, {.meaning = "Middle between the two springings of the intrados.",
                                     .unit = "m",
                                     .required = true}));
  valid =
      t.number("span", arch.span, rules(shape, length("Between the springings of the intrados."))) && valid;
  valid = t.number("rise", arch.rise,
                   rules(shape, length("Of the crown of the intrados above its springings, at most half "
                                       "the span."))) &&
          valid;
  valid =
      t.number("thickness", arch.thickness, rules(shape, length("Of the ring, along its radial joints."))) &&
      valid;
  valid = t.integer("voussoirs", arch.voussoirs,
                    rules(shape, {.meaning = "How many stones it has.",
                                  .required = true,
                                  .at_least = 1,
                                  .at_most = most_in_row})) &&
          valid;
  if (valid && arch.rise > 0.5 * arch.span) {
    t.fail("rise", fmt::format("the number {}", arch.rise),
           fmt::format("at most half the span, {}", 0.5 * arch.span));
    return false;
  }
  return valid;
}

bool read_column(TableReader& t, BlockMapSpec& map, const ShapeRules& rules) {
  constexpr auto shape = BlockMapShape::column;
  ColumnShape& column = map.column;
  bool valid = t.point("foot", column.foot,
                       rules(shape, {.meaning = "Middle of the base.", .unit = "m", .required = true}));
  valid = t.number("width", column.width, rules(shape, length("At the base: the diameter of the drums."))) &&
          valid;
  Rule top = length("At the top, for a column that tapers.");
  top.required = false;
  top.fallback = "width";
  t.number("top_width", map.top_width, rules(shape, top));
  valid = t.integer("drums", column.drums,
                    rules(shape, {.meaning = "How many, of equal height.",
                                  .required = true,
                                  .at_least = 1,
                                  .at_most = most_in_row})) &&
          valid;
  column.top_width = map.top_width.value_or(column.width);
  return valid;
}

bool read_wall(TableReader& t, WallShape& wall, const ShapeRules& rules) {
  constexpr auto shape = BlockMapShape::wall;
  bool valid = t.point("corner", wall.corner,
                       rules(shape, {.meaning = "Lower left corner.", .unit = "m", .required = true}));
  valid = t.number("length", wall.length, rules(shape, length("Of the wall."))) && valid;
  valid =
      t.number(
          "stone_length", wall.stone_length,
          rules(shape, length("Of a stone, about: a course has a whole number of stones of one length."))) &&
      valid;
  valid = t.number("course_height", wall.course_height,
                   rules(shape, length("Of a course, about: the wall has a whole number of courses."))) &&
          valid;
  t.number(
      "bond", wall.bond,
      rules(shape,
            {.meaning = "Share of a stone by which every second course is shifted; 0.5 is a running bond, "
                        "0 a stack.",
             .at_least = 0.0,
             .below = 1.0}));
  if (valid && count_of_stones(wall) > most_stones) {
    t.fail("stone_length", fmt::format("stones of which the wall has about {:.2g}", count_of_stones(wall)),
           fmt::format("at most {:.0e}", most_stones));
    return false;
  }
  return valid;
}

/// The stones of a shape, without layers.
std::vector<Ring> read_stones(TableReader& t, BlockMapSpec& map, const ShapeRules& rules) {
  double height = 0.0;
  const bool arch = read_arch(t, map.arch, rules), wall = read_wall(t, map.wall, rules),
             column = read_column(t, map, rules);
  const bool high =
      t.number("height", height,
               rules.of_two(BlockMapShape::column, BlockMapShape::wall, "shape = \"column\" or \"wall\"",
                            length("Of the column or the wall.")));
  map.wall.height = map.column.height = height;
  if (arch && rules.has(BlockMapShape::arch)) return arch_stones(map.arch);
  if (column && high && rules.has(BlockMapShape::column)) return column_stones(map.column);
  if (wall && high && rules.has(BlockMapShape::wall)) return wall_stones(map.wall);
  return {};
}

class BlockMapReader {
 public:
  BlockMapReader(TableReader& t, Scenario& scenario, std::vector<DrawnRing>& drawn)
      : t_(t), scenario_(scenario), drawn_(drawn) {}

  void read() {
    BlockMapSpec map;
    t_.name(
        "name", map.name, "block_map",
        {.meaning =
             "Name. Its blocks have this name and a number, from 1 on in their order; one that is alone has "
             "no number. Required with a shape that is no file.",
         .fallback = "that of its only layer, or of the file"});
    const bool is_read = t_.word("shape", map.shape, block_map_shapes,
                                 {.meaning = "Where its blocks come from: a drawing, or measures."});
    const bool known = is_read || t_.find("shape") == nullptr;
    const ShapeRules rules(t_, map.shape, known);
    const bool has_file =
        t_.file("file", map.file,
                rules(BlockMapShape::file,
                      {.meaning = "A drawing (ASCII DXF) or a shapefile: every closed line is a block, see "
                                  "[blocks from drawings](guide/drawings.md#blocks).",
                       .required = true}));
    read_map_choice(t_, map.choice, t_.documenting() || !known || map.shape == BlockMapShape::file,
                    "shape = \"file\"");
    std::vector<DrawnRing> rings;
    if (has_file && rules.has(BlockMapShape::file)) rings = rings_of_file(map);
    for (Ring& stone : read_stones(t_, map, rules)) rings.push_back({std::move(stone), "", {}, ""});
    BlockSpec block;
    t_.boolean("fixed", block.fixed, {.meaning = "Its blocks neither move nor deform."});
    if (block.fixed) t_.judge_nothing();
    read_rock_keys(t_, block.rock, false);
    if (t_.documenting()) return;
    if (map.name.empty() && map.shape != BlockMapShape::file) t_.missing("name", "a name of its blocks");
    add_blocks(map, std::move(block), std::move(rings));
  }

 private:
  std::vector<DrawnRing> rings_of_file(BlockMapSpec& map) {
    scenario_.drawings.push_back(map.file);
    std::string skipped;
    std::vector<DrawnRing> rings = read_rings(map.file, map.choice, t_.context().mistakes, skipped);
    if (!skipped.empty()) scenario_.skipped.push_back(t_.path() + ": left out of the drawing: " + skipped);
    if (map.name.empty())
      map.name = map.choice.layers.size() == 1 ? map.choice.layers.front() : map.file.stem().string();
    drawn_.insert(drawn_.end(), rings.begin(), rings.end());
    return rings;
  }

  void add_blocks(const BlockMapSpec& map, BlockSpec block, std::vector<DrawnRing> rings) {
    ReadContext& context = t_.context();
    std::vector<std::string>& names = context.list_names["block"];
    for (std::size_t k = 0; k < rings.size(); ++k) {
      block.name = rings.size() == 1 ? map.name : fmt::format("{} {}", map.name, k + 1);
      if (std::ranges::find(names, block.name) != names.end()) {
        t_.fail("name", fmt::format("'{}', the name of another block", block.name), "a name of its own");
        return;
      }
      names.push_back(block.name);
      block.path = join_path(t_.path(), block.name);
      if (!rings[k].where.file.empty()) context.positions[block.path] = rings[k].where;
      block.polygon = {std::move(rings[k].ring), {}};
      scenario_.blocks.push_back(block);
    }
  }

  TableReader& t_;
  Scenario& scenario_;
  std::vector<DrawnRing>& drawn_;
};

}  // namespace

void read_map_choice(TableReader& t, rockmass::MapChoice& choice, bool applies, std::string_view condition) {
  constexpr static KeyKind string_list[] = {KeyKind::references};
  const std::string_view type = "array of strings";
  const Value* layers =
      t.any("layers", type,
            only(applies, condition,
                 {.meaning = "Layers of a drawing (DXF) that count. Capitals and small letters are "
                             "the same.",
                  .fallback = "all",
                  .kinds = string_list}));
  if (layers != nullptr) {
    const auto is_text = [](const Value& v) { return v.is(Value::Type::string) && !v.text.empty(); };
    if (!layers->is(Value::Type::array) || layers->items.empty() ||
        !std::ranges::all_of(layers->items, is_text)) {
      t.fail("layers", describe(*layers), "an array of names of layers");
    } else {
      for (const Value& layer : layers->items) choice.layers.push_back(layer.text);
    }
  }
  drawing::Placement& placement = choice.placement;
  t.number("scale", placement.scale,
           only(applies, condition,
                {.meaning = "Metres of a unit of the file.",
                 .unit = "m",
                 .above = 0.0,
                 .fallback = "the unit that a drawing names ($INSUNITS), else 1"}));
  t.point("origin", placement.origin,
          only(applies, condition,
               {.meaning = "Point of the file, in its units, that becomes [0, 0] in the section.",
                .unit = "of the file"}));
  t.number("rotate", placement.rotate,
           only(applies, condition,
                {.meaning = "Angle by which the lines are turned about `origin`, counter-clockwise.",
                 .unit = "°",
                 .at_least = -360.0,
                 .at_most = 360.0,
                 .usual = &usual::angle}));
}

void read_drawn_outline(TableReader& t, ExcavationSpec& spec, const rockmass::MapChoice& choice,
                        const std::filesystem::path& file, Scenario& scenario) {
  scenario.drawings.push_back(file);
  Mistakes mistakes;
  std::string skipped;
  std::vector<DrawnRing> rings = read_rings(file, choice, mistakes, skipped);
  t.context().mistakes.add(mistakes);
  if (!skipped.empty()) scenario.skipped.push_back(t.path() + ": left out of the drawing: " + skipped);
  if (rings.size() == 1) spec.outer = std::move(rings.front().ring);
  if (rings.size() > 1)
    t.fail("file",
           fmt::format("{} closed lines, in lines {} and {} first", rings.size(), rings[0].where.line,
                       rings[1].where.line),
           "one outline; choose its layer by layers");
}

void read_block_maps(TableReader& root, Scenario& scenario) {
  std::vector<DrawnRing> drawn;
  root.each_table(
      "block_map",
      {.meaning = "Blocks of a drawing, or of masonry by its measures: each is like a [[block]]."},
      [&](TableReader& t) { BlockMapReader(t, scenario, drawn).read(); });
  if (!root.documenting()) check_overlaps(drawn, root.context().mistakes);
}

}  // namespace keyblock::scenario
