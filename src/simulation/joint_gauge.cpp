#include "simulation/joint_gauge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "core/index.h"

namespace keyblock::simulation {

void JointGauge::start(std::span<const contact::Contact> contacts) {
  pieces_.clear();
  const auto is_frame = [&](int b) { return at(b) >= setup_.properties.size(); };
  for (const contact::Contact& c : contacts) {
    if (c.length <= 0.0 || is_frame(c.block_a) || is_frame(c.block_b)) continue;
    pieces_.push_back({c.vertex, c.edge, c.position, c.length});
  }
  std::sort(pieces_.begin(), pieces_.end(), [](const Piece& x, const Piece& y) {
    return std::tie(x.vertex, x.edge) < std::tie(y.vertex, y.edge);
  });
}

JointGauge::Offset JointGauge::offset(const Piece& piece) const {
  const contact::Surface& surface = model_.surface;
  const Vec2 a = surface.position[at(piece.edge)], b = surface.position[at(surface.next[at(piece.edge)])];
  const Vec2 tangent = normalized(b - a),
             apart = surface.position[at(piece.vertex)] - lerp(a, b, piece.along);
  return {dot(tangent, apart), dot(Vec2{tangent.y, -tangent.x}, apart)};
}

bool JointGauge::in_place(const Piece& piece, std::span<const BlockStatus> status) const {
  const std::size_t a = at(model_.surface.block[at(piece.vertex)]),
                    b = at(model_.surface.block[at(piece.edge)]);
  return status[a] < BlockStatus::fallen && status[b] < BlockStatus::fallen;
}

void JointGauge::watch(std::span<const BlockStatus> status) {
  for (Piece& piece : pieces_) {
    if (!in_place(piece, status)) continue;
    const Offset now = offset(piece);
    piece.slip_ever = std::max(piece.slip_ever, std::abs(now.slip));
    piece.opening_ever = std::max(piece.opening_ever, now.opening);
  }
}

int JointGauge::hinges(std::span<const BlockStatus> status) const {
  struct Ends {
    bool open = false, closed = false;
  };
  std::map<std::pair<int, int>, Ends> joints;
  for (const Piece& piece : pieces_) {
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

void JointGauge::measure(std::span<const BlockStatus> status, Damage& damage) const {
  damage.hinges = hinges(status);
  double length = 0.0, slip_length = 0.0;
  for (const Piece& piece : pieces_) {
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

double JointGauge::slip(int vertex, int edge) const {
  const auto piece = std::lower_bound(pieces_.begin(), pieces_.end(), std::pair{vertex, edge},
                                      [](const Piece& p, const auto& key) {
                                        return std::pair{p.vertex, p.edge} < key;
                                      });
  return piece != pieces_.end() && piece->vertex == vertex && piece->edge == edge ? offset(*piece).slip : 0.0;
}

}  // namespace keyblock::simulation
