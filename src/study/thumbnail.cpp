#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "core/index.h"
#include "study/outputs.h"

namespace keyblock::study {

namespace {

/// Width of the window in units of the picture: blocks are drawn at whole units, which are fewer letters than decimals. The finest
/// with which the picture is small enough is taken, or the last. Below about 700 a round opening that fills a screen has kinks.
constexpr std::array<int, 9> resolutions{2000, 1400, 1000, 850, 700, 500, 320, 250, 140};
constexpr std::size_t largest_size = 12'000;
/// Room around the openings, as a share of their size: about 1.3 widths from the centre of a single one.
constexpr double room = 0.8;
/// Beyond the rock, as a share of its size.
constexpr double edge = 0.02;

constexpr std::string_view style =
    "<style>.r{fill:#e4e1d8;stroke:#6b6f73}.x{fill:#d3d5d7;stroke:#6b6f73}.l{fill:#e69f00;stroke:#33373b}"
    ".f{fill:#d55e00;stroke:#33373b}.o{fill:none;stroke:#c2185b}.s{fill:none;stroke:#0072b2}"
    ".d{fill:none;stroke:#16181b}"
    "@media (prefers-color-scheme:dark){.r{fill:#4a4d50;stroke:#16181b}.x{fill:#33373b;stroke:#16181b}"
    ".l,.f{stroke:#0d0e10}.o{stroke:#ff6fa8}.s{stroke:#56b4e9}"
    ".d{stroke:#f6f5f2}}</style>";

/// Of the window, how long the longest arrow is; a head, of its arrow.
constexpr double longest_arrow = 0.06, head_share = 0.35;
/// Of the longest way, below which there is no arrow.
constexpr double least_way = 0.05;
/// Blocks that are drawn an arrow, the heaviest first, and joints that are drawn: more are not told apart.
constexpr std::size_t most_arrows = 150, most_slips = 400;

enum class Class { rock, fixed, loosened, fallen };
constexpr std::array<char, 4> class_names{'r', 'x', 'l', 'f'};

struct Unit {
  long x, y;
  friend bool operator==(Unit, Unit) = default;
};

class Drawing {
 public:
  Drawing(const record::ModelRecord& model, const record::Frame& frame, const Mechanism& mechanism)
      : model_(model), frame_(frame), mechanism_(mechanism) {
    for (const auto& outline : model.excavation_outlines)
      for (const Vec2 p : outline) window_.add(p);
    Box rock;
    for (std::size_t b = 0; b < model.blocks.size(); ++b)
      if (!model.blocks[b].fixed && class_of(b)) add_ring(rock, b);
    if (window_.min.x > window_.max.x) {
      window_ = rock;
      if (window_.min.x > window_.max.x)
        for (const Vec2 p : model.vertices) window_.add(p);
    } else {
      show_around_openings(rock);
    }
    if (window_.min.x > window_.max.x) window_ = {{0.0, 0.0}, {1.0, 1.0}};
  }

  [[nodiscard]] std::string draw(int resolution) const {
    const Vec2 size = window_.size();
    const double scale = resolution / std::max({size.x, size.y, 1e-300});
    std::array<std::string, 4> paths;
    std::array<Unit, 4> pen{};
    for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
      const auto what = class_of(b);
      if (!what) continue;
      Box box;
      add_ring(box, b);
      if (box.max.x < window_.min.x || box.min.x > window_.max.x || box.max.y < window_.min.y ||
          box.min.y > window_.max.y)
        continue;
      const auto c = static_cast<std::size_t>(*what);
      add_block(paths[c], pen[c], b, scale);
    }
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" stroke-width=\"{:.2g}\" "
        "stroke-linejoin=\"round\">{}",
        std::lround(size.x * scale), std::lround(size.y * scale), resolution / 500.0, style);
    for (std::size_t c = 0; c < paths.size(); ++c)
      if (!paths[c].empty()) svg += fmt::format("<path class=\"{}\" d=\"{}\"/>", class_names[c], paths[c]);
    for (const auto& outline : model_.excavation_outlines) {
      std::string path;
      Unit from{0, 0};
      std::vector<Unit> ring;
      for (const Vec2 p : outline) ring.push_back(unit(p, scale));
      add_ring(path, from, ring);
      if (!path.empty()) {
        svg += fmt::format(
            "<path class=\"o\" stroke-width=\"{:.2g}\" stroke-dasharray=\"{:.2g} {:.2g}\" d=\"{}\"/>",
            resolution / 200.0, resolution / 66.0, resolution / 100.0, path);
      }
    }
    if (mechanism_.is_known()) svg += slips(scale, resolution) + arrows(scale, resolution);
    return svg + "</svg>\n";
  }

 private:
  [[nodiscard]] bool goes(std::size_t block) const {
    const auto what = class_of(block);
    return what == Class::loosened || what == Class::fallen;
  }

  /// m, of the display vertices of a block, in the mean: where they are, and how far they went in the stage.
  struct Way {
    Vec2 middle, way;
    double area = 0.0;
  };
  [[nodiscard]] Way way_of(std::size_t block) const {
    const auto& starts = model_.blocks[block].ring_start;
    Way all{{}, {}, model_.blocks[block].area};
    const double share = 1.0 / std::max(1, starts[1] - starts[0]);
    for (int v = starts[0]; v < starts[1]; ++v) {
      all.middle += share * position(v);
      const auto &now = frame_.displacement[at(v)], &before = mechanism_.start.displacement[at(v)];
      all.way += share * Vec2{now[0] - before[0], now[1] - before[1]};
    }
    return all;
  }

  [[nodiscard]] std::string arrows(double scale, int resolution) const {
    std::vector<Way> ways;
    double farthest = 0.0;
    for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
      if (!goes(b)) continue;
      ways.push_back(way_of(b));
      farthest = std::max(farthest, norm(ways.back().way));
    }
    std::ranges::sort(ways, std::greater<>{}, &Way::area);
    if (ways.size() > most_arrows) ways.resize(most_arrows);
    std::string path;
    for (const Way& of : ways) {
      if (!(norm(of.way) > least_way * farthest)) continue;
      const Vec2 along = longest_arrow * resolution / scale / farthest * of.way,
                 side = head_share * Vec2{-along.y, along.x};
      const Vec2 tip = of.middle + 0.5 * along, neck = tip - head_share * along;
      const Unit a = unit(of.middle - 0.5 * along, scale), b = unit(tip, scale),
                 l = unit(neck + 0.5 * side, scale), r = unit(neck - 0.5 * side, scale);
      path += fmt::format("M{} {}L{} {}M{} {}L{} {}L{} {}", a.x, a.y, b.x, b.y, l.x, l.y, b.x, b.y, r.x, r.y);
    }
    return path.empty() ? path
                        : fmt::format("<path class=\"d\" stroke-width=\"{:.2g}\" d=\"{}\"/>",
                                      resolution / 250.0, path);
  }

  /// Joints of blocks that move, where they slip.
  [[nodiscard]] std::string slips(double scale, int resolution) const {
    std::string path;
    std::size_t count = 0;
    for (const record::ContactRecord& c : mechanism_.contacts) {
      if (c.state != record::ContactState::sliding || !(goes(at(c.block_a)) || goes(at(c.block_b)))) continue;
      if (count++ == most_slips) break;
      const Vec2 half = 0.5 * c.length * Vec2{-c.normal.y, c.normal.x};
      const Unit a = unit(c.position - half, scale), b = unit(c.position + half, scale);
      path += fmt::format("M{} {}L{} {}", a.x, a.y, b.x, b.y);
    }
    return path.empty() ? path
                        : fmt::format("<path class=\"s\" stroke-width=\"{:.2g}\" d=\"{}\"/>",
                                      resolution / 140.0, path);
  }

  /// The openings, and what is around them. What lies in front of a slope is open to the edge of the rock: beyond it there is nothing to show.
  void show_around_openings(Box rock) {
    const Vec2 size = window_.size();
    rock.add(window_);
    rock = rock.grown(edge * std::max(rock.size().x, rock.size().y));
    window_ = window_.grown(room * std::max(size.x, size.y));
    window_.min = {std::max(window_.min.x, rock.min.x), std::max(window_.min.y, rock.min.y)};
    window_.max = {std::min(window_.max.x, rock.max.x), std::min(window_.max.y, rock.max.y)};
  }

  /// None: excavated, not drawn.
  [[nodiscard]] std::optional<Class> class_of(std::size_t block) const {
    if (model_.blocks[block].fixed) return Class::fixed;
    const auto status = block < frame_.status.size() ? frame_.status[block] : record::BlockStatus::in_place;
    switch (status) {
      case record::BlockStatus::excavated:
        return std::nullopt;
      case record::BlockStatus::fallen:
        return Class::fallen;
      case record::BlockStatus::loosened:
        return Class::loosened;
      case record::BlockStatus::in_place:
        break;
    }
    return Class::rock;
  }

  [[nodiscard]] Vec2 position(int vertex) const {
    const Vec2 p = model_.vertices[at(vertex)];
    if (at(vertex) >= frame_.displacement.size()) return p;
    const auto& u = frame_.displacement[at(vertex)];
    return p + Vec2{u[0], u[1]};
  }

  [[nodiscard]] Unit unit(Vec2 p, double scale) const {
    return {std::lround((p.x - window_.min.x) * scale), std::lround((window_.max.y - p.y) * scale)};
  }

  void add_ring(Box& box, std::size_t block) const {
    const auto& starts = model_.blocks[block].ring_start;
    for (int v = starts.front(); v < starts.back(); ++v) box.add(position(v));
  }

  void add_block(std::string& path, Unit& from, std::size_t block, double scale) const {
    const auto& starts = model_.blocks[block].ring_start;
    for (std::size_t r = 0; r + 1 < starts.size(); ++r) {
      std::vector<Unit> ring;
      for (int v = starts[r]; v < starts[r + 1]; ++v) ring.push_back(unit(position(v), scale));
      add_ring(path, from, ring);
    }
  }

  /// A closed path in steps from the point before; points that fall together, or on a line, are one.
  static void add_ring(std::string& path, Unit& from, const std::vector<Unit>& ring) {
    std::vector<Unit> kept;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      if (!kept.empty() && ring[k] == kept.back()) continue;
      if (kept.size() >= 2 && on_line(kept[kept.size() - 2], kept.back(), ring[k])) kept.pop_back();
      kept.push_back(ring[k]);
    }
    while (kept.size() > 1 && kept.back() == kept.front()) kept.pop_back();
    if (kept.size() < 3) return;
    path += 'm';
    step(path, from, kept[0]);
    path += 'l';
    for (std::size_t k = 1; k < kept.size(); ++k) step(path, kept[k - 1], kept[k], k > 1);
    path += 'z';
    from = kept[0];
  }

  static bool on_line(Unit a, Unit b, Unit c) {
    return (b.x - a.x) * (c.y - b.y) == (b.y - a.y) * (c.x - b.x) &&
           (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) > 0;
  }

  static void step(std::string& path, Unit a, Unit b, bool apart = false) {
    const long x = b.x - a.x, y = b.y - a.y;
    if (apart && x >= 0) path += ' ';
    fmt::format_to(std::back_inserter(path), "{}{}{}", x, y < 0 ? "" : " ", y);
  }

  const record::ModelRecord& model_;
  const record::Frame& frame_;
  const Mechanism& mechanism_;
  Box window_;
};

}  // namespace

std::string thumbnail_svg(const record::ModelRecord& model, const record::Frame& frame,
                          const Mechanism& mechanism) {
  const Drawing drawing(model, frame, mechanism);
  std::string svg;
  for (const int resolution : resolutions) {
    svg = drawing.draw(resolution);
    if (svg.size() <= largest_size) break;
  }
  return svg;
}

}  // namespace keyblock::study
