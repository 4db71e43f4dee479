#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/index.h"
#include "picture/force_chains.h"
#include "picture/layers.h"

namespace keyblock::picture {
namespace {

std::string marks(const std::string& path, std::string_view color, double width, std::string_view more = "") {
  if (path.empty()) return path;
  return fmt::format(
      "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linecap=\"round\" "
      "stroke-linejoin=\"round\"{} d=\"{}\"/>\n",
      color, width, more, path);
}

// Where the force of a pair ends: at a centroid, or where it touches a fixed block.
Vec2 end_at(const Canvas& canvas, int block, Vec2 middle) {
  return canvas.run.model.blocks[at(block)].fixed ? middle : canvas.place.middle(at(block));
}

Vec2 where_drawn(const Canvas& canvas, const ForceChain& chain) {
  const int mover = canvas.run.model.blocks[at(chain.block_a)].fixed ? chain.block_b : chain.block_a;
  return canvas.place.shifted(chain.middle, at(mover));
}

}  // namespace

std::string draw_forces(const Canvas& canvas, const record::ContactFrame& contacts, double typical) {
  constexpr double least = 0.01, most = 2.0;  // of the typical force
  constexpr double steps_of_width = 5.0;      // per unit: lines of one width are one path
  std::map<long, std::string> paths;
  for (const ForceChain& chain : force_chains(contacts)) {
    if (chain.force < least * typical) continue;
    const double width = mark_of("forces").drawn * std::min(chain.force / typical, most);
    std::string& path = paths[std::max(1L, std::lround(steps_of_width * width))];
    const Vec2 middle = where_drawn(canvas, chain);
    canvas.view.point(path, 'M', end_at(canvas, chain.block_a, middle));
    canvas.view.point(path, 'L', middle);
    canvas.view.point(path, 'L', end_at(canvas, chain.block_b, middle));
  }
  std::string svg;
  for (const auto& [width, path] : paths)
    svg += marks(path, force_color, static_cast<double>(width) / steps_of_width, " stroke-opacity=\"0.85\"");
  return svg;
}

std::string draw_thrust(const Canvas& canvas, const record::ContactFrame& contacts, double typical) {
  constexpr double least = 0.01;  // of the typical force
  const std::vector<ForceChain> chains = force_chains(contacts);
  std::string line, hinges;
  for (const Thrust& thrust : lines_of_thrust(canvas.run.model, chains)) {
    if (thrust.force < least * typical) continue;
    canvas.view.line(line, canvas.place.shifted(thrust.from, at(thrust.block)),
                     canvas.place.shifted(thrust.to, at(thrust.block)));
  }
  for (const ForceChain& chain : chains) {
    if (!chain.is_hinge() || chain.force < least * typical) continue;
    const Vec2 p = where_drawn(canvas, chain);
    canvas.view.line(hinges, p, p);
  }
  // A line of no length with round ends is a dot.
  return marks(line, "#ffffff", 4.5) + marks(line, outline_color, 2.5) + marks(hinges, "#ffffff", 13.0) +
         marks(hinges, outline_color, 10.0);
}

std::string draw_crosses(const Canvas& canvas, double typical) {
  std::string compression, tension;
  const auto& frame = canvas.place.frame();
  for (std::size_t b = 0; b < canvas.run.model.blocks.size(); ++b) {
    if (!canvas.place.is_drawn(b)) continue;
    const Principal p = principal_of(frame.stress[b]);
    const Vec2 middle = canvas.place.middle(b), along{std::cos(p.angle), std::sin(p.angle)};
    const auto bar = [&](double stress, Vec2 direction) {
      const Vec2 half =
          0.5 * mark_of("stress").drawn * canvas.block_size * std::abs(stress) / typical * direction;
      canvas.view.line(stress < 0.0 ? compression : tension, middle - half, middle + half);
    };
    bar(p.larger, along);
    bar(p.smaller, perpendicular(along));
  }
  return marks(compression, compression_color, 1.5) + marks(tension, tension_color, 1.5);
}

std::string draw_arrows(const Canvas& canvas, const std::vector<Vec2>& vectors, double typical) {
  constexpr double least = 0.125, head = 0.3, slope = 0.5;
  const double length_of_arrows = mark_of("displacement").drawn;
  std::string path;
  for (std::size_t b = 0; b < vectors.size(); ++b) {
    const double size = norm(vectors[b]) / typical;
    if (!canvas.place.is_drawn(b) || !(size > least)) continue;
    // What has fallen has gone farther than any arrow could show.
    if (canvas.place.frame().status[b] == record::BlockStatus::fallen) continue;
    const double length = length_of_arrows * canvas.block_size * std::min(size, longest_arrow);
    const Vec2 along = normalized(vectors[b]), from = canvas.place.middle(b), tip = from + length * along;
    const double back = head * std::min(length, length_of_arrows * canvas.block_size);
    canvas.view.line(path, from, tip);
    canvas.view.point(path, 'M', tip - back * along + slope * back * perpendicular(along));
    canvas.view.point(path, 'L', tip);
    canvas.view.point(path, 'L', tip - back * along - slope * back * perpendicular(along));
  }
  return marks(path, "#ffffff", 3.2) + marks(path, arrow_color, 1.6);
}

}  // namespace keyblock::picture
