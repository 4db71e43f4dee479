#include "simulation/joint_gauge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "core/index.h"
#include "core/lanes.h"

namespace keyblock::simulation {

void JointGauge::start(std::span<const contact::Contact> contacts) {
  std::vector<Piece> pieces;
  const auto is_frame = [&](int b) { return at(b) >= setup_.properties.size(); };
  for (const contact::Contact& c : contacts) {
    if (c.length <= 0.0 || is_frame(c.block_a) || is_frame(c.block_b)) continue;
    pieces.push_back({c.vertex, c.edge, c.position, c.length});
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& x, const Piece& y) {
    return std::tie(x.vertex, x.edge) < std::tie(y.vertex, y.edge);
  });
  restore(std::move(pieces));
}

void JointGauge::restore(std::vector<Piece> pieces) {
  pieces_.assign(std::move(pieces), model_.surface.position.size());
}

JointGauge::Offset JointGauge::offset(const Piece& piece) const {
  const contact::Surface& surface = model_.surface;
  const Vec2 a = surface.position[at(piece.edge)], b = surface.position[at(surface.next[at(piece.edge)])];
  const Vec2 tangent = normalized(b - a),
             apart = surface.position[at(piece.vertex)] - lerp(a, b, piece.along);
  return {dot(tangent, apart), dot(Vec2{tangent.y, -tangent.x}, apart)};
}

bool JointGauge::in_place(const Piece& piece, std::span<const record::BlockStatus> status) const {
  const std::size_t a = at(model_.surface.block[at(piece.vertex)]),
                    b = at(model_.surface.block[at(piece.edge)]);
  return status[a] < record::BlockStatus::fallen && status[b] < record::BlockStatus::fallen;
}

void JointGauge::watch(std::span<const record::BlockStatus> status) {
  for (Piece& piece : pieces_.all()) {
    if (!in_place(piece, status)) continue;
    const Offset now = offset(piece);
    piece.slip_ever = std::max(piece.slip_ever, std::abs(now.slip));
    piece.opening_ever = std::max(piece.opening_ever, now.opening);
  }
}

int JointGauge::hinges(std::span<const record::BlockStatus> status) const {
  struct Ends {
    bool open = false, closed = false;
  };
  std::map<std::pair<int, int>, Ends> joints;
  for (const Piece& piece : pieces_.all()) {
    if (!in_place(piece, status)) continue;
    const std::pair<int, int> blocks =
        std::minmax(model_.surface.block[at(piece.vertex)], model_.surface.block[at(piece.edge)]);
    const bool open = offset(piece).opening > setup_.damage.opening;
    (open ? joints[blocks].open : joints[blocks].closed) = true;
  }
  return static_cast<int>(std::count_if(joints.begin(), joints.end(), [](const auto& joint) {
    return joint.second.open && joint.second.closed;
  }));
}

void JointGauge::measure(std::span<const record::BlockStatus> status, record::Damage& damage) const {
  damage.hinges = hinges(status);
  double length = 0.0, slip_length = 0.0;
  for (const Piece& piece : pieces_.all()) {
    damage.slip_max_ever = std::max(damage.slip_max_ever, piece.slip_ever);
    damage.opening_max_ever = std::max(damage.opening_max_ever, piece.opening_ever);
    if (piece.slip_ever > setup_.damage.slip) damage.slipped_length_ever += piece.length;
    if (piece.opening_ever > setup_.damage.opening) damage.opened_length_ever += piece.length;
    if (!in_place(piece, status)) continue;
    const Offset now = offset(piece);
    const double slip = std::abs(now.slip);
    damage.slip_max = std::max(damage.slip_max, slip);
    damage.opening_max = std::max(damage.opening_max, now.opening);
    slip_length += slip * piece.length;
    length += piece.length;
    if (slip > setup_.damage.slip) damage.slipped_length += piece.length;
    if (now.opening > setup_.damage.opening) damage.opened_length += piece.length;
  }
  damage.slip_mean = length > 0.0 ? slip_length / length : 0.0;
}

void JointGauge::slips(std::span<const contact::Contact> contacts, std::span<double> slips) const {
  std::fill(slips.begin(), slips.end(), 0.0);
  if (pieces_.empty()) return;
  const std::span<const Vec2> position = model_.surface.position;
  in_lanes(static_cast<int>(contacts.size()), [&](int first, int count) {
    std::array<double, lane_count> along_x, along_y, apart_x{}, apart_y{};
    along_x.fill(1.0);
    along_y.fill(0.0);
    for (int k = 0; k < count; ++k) {
      const contact::Contact& c = contacts[at(first + k)];
      const Piece* piece = pieces_.find(c.vertex, c.edge);
      if (piece == nullptr) continue;
      const Vec2 a = position[at(c.edge)], b = position[at(model_.surface.next[at(c.edge)])],
                 apart = position[at(c.vertex)] - lerp(a, b, piece->along);
      along_x[at(k)] = b.x - a.x;
      along_y[at(k)] = b.y - a.y;
      apart_x[at(k)] = apart.x;
      apart_y[at(k)] = apart.y;
    }
    // As in offset(), to the same bits.
    const Lanes x = load(along_x.data()), y = load(along_y.data()), length = square_root(x * x + y * y);
    store_first(&slips[at(first)], x / length * load(apart_x.data()) + y / length * load(apart_y.data()),
                count);
  });
}

}  // namespace keyblock::simulation
