#include "simulation/build_liners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/liner_coupling.h"
#include "simulation/bolt_nodes.h"
#include "simulation/build_bolts.h"

namespace keyblock::simulation {

namespace {

using dynamics::LinerStation;
using loading::Liner;

constexpr double into_rock = 1e-3;      // of the thickness: where rock is looked for beside the wall
constexpr double least_cell = 0.5;      // of the spacing of stations
constexpr double least_overlap = 1e-6;  // likewise, of a block with a cell
constexpr int least_of_ring = 12;       // stations

/// The wall of a liner by the way along it.
class WallLine {
 public:
  explicit WallLine(const Liner& liner) : points_(liner.wall) {
    if (liner.is_closed) points_.push_back(points_.front());
    ends_.push_back(0.0);
    for (std::size_t k = 1; k < points_.size(); ++k)
      ends_.push_back(ends_.back() + norm(points_[k] - points_[k - 1]));
  }
  [[nodiscard]] double length() const { return ends_.back(); }
  [[nodiscard]] std::size_t sides() const { return points_.size() - 1; }
  [[nodiscard]] double start(std::size_t side) const { return ends_[side]; }
  [[nodiscard]] std::pair<Vec2, Vec2> side(std::size_t k) const { return {points_[k], points_[k + 1]}; }
  [[nodiscard]] Vec2 at_way(double way) const {
    const auto after = std::ranges::upper_bound(ends_, way);
    const std::size_t k = std::min(
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - ends_.begin() - 1, 0)), sides() - 1);
    return lerp(points_[k], points_[k + 1], (way - ends_[k]) / (ends_[k + 1] - ends_[k]));
  }

 private:
  std::vector<Vec2> points_;
  std::vector<double> ends_;
};

/// The blocks on the right of the wall, m along it.
std::vector<BoltPiece> rock_of(const RunSetup& setup, const Liner& liner, const WallLine& wall) {
  std::vector<BoltPiece> all;
  for (std::size_t k = 0; k < wall.sides(); ++k) {
    const auto [a, b] = wall.side(k);
    const Vec2 along = normalized(b - a), aside = into_rock * liner.thickness * Vec2{along.y, -along.x};
    for (BoltPiece piece : rock_along(setup, a + aside, b + aside, liner.staged)) {
      piece.from += wall.start(k);
      piece.to += wall.start(k);
      all.push_back(piece);
    }
  }
  return all;
}

double spacing_of(const Liner& liner, const WallLine& wall) {
  const double most = liner.is_closed ? wall.length() / least_of_ring : wall.length();
  return std::min(liner.station_spacing(), most);
}

struct BodyOfStation {
  std::size_t body;  ///< among those of its liner
  int outer;
};

/// A body has N/2 stations. Two bodies take turns.
BodyOfStation body_of_station(std::size_t i, int size) {
  const std::size_t each = at(size / 2), group = i / (2 * each), in_group = i % (2 * each);
  return {2 * group + in_group % 2, 2 * static_cast<int>(in_group / 2)};
}

std::size_t bodies_of(std::size_t stations, int size) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < stations; ++i) count = std::max(count, body_of_station(i, size).body + 1);
  return count;
}

/// By whose forces a liner is measured: the heaviest block that moves, or else any.
int heaviest_of(const RunSetup& setup, const std::vector<LinerCell>& cells) {
  int heaviest = 0;
  double most = -1.0;
  for (const LinerCell& cell : cells) {
    for (const auto& [block, length] : cell.blocks) {
      const BlockProperties& properties = setup.properties[block];
      const double mass = properties.material.density * area(setup.system.blocks[block].polygon),
                   counts = properties.fixed ? 0.0 : mass;
      if (counts <= most) continue;
      most = counts;
      heaviest = static_cast<int>(block);
    }
  }
  return heaviest;
}

class LinerBuilder {
 public:
  LinerBuilder(const RunSetup& setup, const dynamics::Model& model, std::size_t k, std::size_t first_body,
               std::vector<LinerStation>& stations, std::vector<dynamics::LinerBeam>& beams,
               std::vector<dynamics::LinerLink>& links)
      : liner_(setup.liners[k]),
        model_(model),
        k_(k),
        first_body_(first_body),
        size_(body_size(setup)),
        wall_(liner_),
        cells_(liner_cells(setup, k)),
        stations_(stations),
        beams_(beams),
        links_(links) {}

  std::size_t build() {
    const std::size_t first = stations_.size(), n = cells_.size();
    for (std::size_t i = 0; i < n; ++i) add_station(i, first);
    for (std::size_t i = 0; i + 1 < n; ++i) add_beam(first + i, first + i + 1);
    if (liner_.is_closed) add_beam(first + n - 1, first);
    return bodies_of(n, size_);
  }

 private:
  void add_station(std::size_t i, std::size_t first) {
    const LinerCell& cell = cells_[i];
    const BodyOfStation place = body_of_station(i, size_);
    const Vec2 along = normalized(wall_.at_way(cell.to) - wall_.at_way(cell.from));
    LinerStation s;
    s.name = fmt::format("{}.{}", liner_.name, i + 1);
    s.liner = k_;
    s.body = static_cast<int>(first_body_ + place.body);
    s.outer = place.outer;
    s.length = cell.length();
    s.area = 0.5 * liner_.thickness * cell.length();
    s.wall = wall_.at_way(0.5 * (cell.from + cell.to));
    s.out = {along.y, -along.x};
    const std::size_t n = cells_.size();
    s.before = i > 0              ? static_cast<int>(first + i - 1)
               : liner_.is_closed ? static_cast<int>(first + n - 1)
                                  : -1;
    s.after = i + 1 < n ? static_cast<int>(first + i + 1) : liner_.is_closed ? static_cast<int>(first) : -1;
    for (const auto& [block, length] : cell.blocks)
      links_.push_back({stations_.size(), length, material_point(model_, block, s.wall)});
    stations_.push_back(std::move(s));
  }
  void add_beam(std::size_t from, std::size_t to) {
    const auto centre = [&](const LinerStation& s) { return s.wall - 0.5 * liner_.thickness * s.out; };
    const LinerStation &a = stations_[from], &b = stations_[to];
    const double least = 0.25 * (a.length + b.length);  // at a corner centre lines may all but meet
    beams_.push_back({from, to, std::max(norm(centre(b) - centre(a)), least)});
  }

  const Liner& liner_;
  const dynamics::Model& model_;
  std::size_t k_, first_body_;
  int size_;
  WallLine wall_;
  std::vector<LinerCell> cells_;
  std::vector<LinerStation>& stations_;
  std::vector<dynamics::LinerBeam>& beams_;
  std::vector<dynamics::LinerLink>& links_;
};

}  // namespace

double rock_beside(const RunSetup& setup, const Liner& liner) {
  double sum = 0.0;
  for (const BoltPiece& piece : rock_of(setup, liner, WallLine(liner))) sum += piece.length();
  return sum;
}

std::vector<LinerCell> liner_cells(const RunSetup& setup, std::size_t k) {
  const Liner& liner = setup.liners[k];
  const WallLine wall(liner);
  const double spacing = spacing_of(liner, wall), least = least_cell * spacing, length = wall.length();
  const std::vector<BoltPiece> rock = rock_of(setup, liner, wall);
  std::vector<double> ends;
  for (const BoltPiece& piece : rock) ends.insert(ends.end(), {piece.from, piece.to});
  std::ranges::sort(ends);
  std::vector<double> divided{0.0};
  const auto divide_to = [&](double end) {
    const double from = divided.back();
    const int count = std::max(1, static_cast<int>(std::ceil((end - from) / spacing - 1e-9)));
    for (int i = 1; i <= count; ++i)
      divided.push_back(i == count ? end : std::lerp(from, end, double(i) / count));
  };
  for (const double end : ends) {
    if (end > divided.back() + least && end < length - least) divide_to(end);
  }
  divide_to(length);
  std::vector<LinerCell> cells;
  for (std::size_t i = 0; i + 1 < divided.size(); ++i) {
    LinerCell cell{divided[i], divided[i + 1], {}};
    for (const BoltPiece& piece : rock) {
      const double overlap = std::min(piece.to, cell.to) - std::max(piece.from, cell.from);
      if (overlap <= least_overlap * spacing) continue;
      const auto known = std::ranges::find(cell.blocks, piece.block, &std::pair<std::size_t, double>::first);
      if (known != cell.blocks.end()) {
        known->second += overlap;
      } else {
        cell.blocks.emplace_back(piece.block, overlap);
      }
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

void add_liner_lines(const RunSetup& setup, std::vector<dynamics::LineBody>& lines) {
  for (std::size_t k = 0; k < setup.liners.size(); ++k) {
    const Liner& liner = setup.liners[k];
    const std::vector<LinerCell> cells = liner_cells(setup, k);
    dynamics::LineBody line;
    line.size = body_size(setup);
    line.material.density = liner.density;
    line.material.young = liner.young;
    line.block = heaviest_of(setup, cells);
    const std::size_t first = lines.size();
    lines.resize(first + bodies_of(cells.size(), line.size), line);
    for (std::size_t i = 0; i < cells.size(); ++i)
      lines[first + body_of_station(i, line.size).body].area += liner.thickness * cells[i].length();
  }
}

std::shared_ptr<const dynamics::Coupling> liner_coupling(const RunSetup& setup,
                                                         const dynamics::Model& model) {
  if (setup.liners.empty()) return nullptr;
  std::vector<LinerStation> stations;
  std::vector<dynamics::LinerBeam> beams;
  std::vector<dynamics::LinerLink> links;
  std::size_t next = model.blocks.size() + bolt_lines(setup).size();
  for (std::size_t k = 0; k < setup.liners.size(); ++k)
    next += LinerBuilder(setup, model, k, next, stations, beams, links).build();
  return std::make_shared<dynamics::LinerCoupling>(setup.liners, std::move(stations), std::move(beams),
                                                   std::move(links), model);
}

}  // namespace keyblock::simulation
