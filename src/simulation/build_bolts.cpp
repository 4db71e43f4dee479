#include "simulation/build_bolts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/index.h"
#include "simulation/history_block.h"
#include "simulation/refuse.h"

namespace keyblock::simulation {

namespace {

using loading::Bolt;
using loading::BoltSide;

// Of the length of a bolt: stretches of rock and gaps that are not seen; how far the line of a bolt is moved aside, so that a joint along it is
// on one side; how far an end may be from rock.
constexpr double least_share = 1e-6, aside_share = 1e-8, end_share = 2e-3;

Vec2 axis_of(const Bolt& bolt) {
  return (bolt.toe - bolt.head) / bolt.length();
}

/// m from `head`, where the line crosses a ring, beyond either end too.
void add_crossings(const Ring& ring, Vec2 head, Vec2 axis, std::vector<double>& places) {
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k] - head, b = ring[(k + 1) % ring.size()] - head;
    const double of_a = cross(axis, a), of_b = cross(axis, b);
    if ((of_a > 0.0) != (of_b > 0.0)) places.push_back(dot(axis, lerp(a, b, of_a / (of_a - of_b))));
  }
}

/// The stage that installs a support, by index; −1: it is there from the start.
std::ptrdiff_t installing_stage(const RunSetup& setup, int staged) {
  if (staged < 0) return -1;
  const std::string& name = setup.staged_supports[at(staged)];
  const auto installs = [&](const record::Stage& stage) {
    return std::ranges::find(stage.install, name) != stage.install.end();
  };
  return std::ranges::find_if(setup.stages, installs) - setup.stages.begin();
}

/// Whether the block is excavated before the bolt comes, or as it does.
bool is_gone(const RunSetup& setup, std::size_t block, std::ptrdiff_t installed) {
  const auto stage = excavating_stage(setup, block);
  return stage && static_cast<std::ptrdiff_t>(*stage) <= installed;
}

[[noreturn]] void refuse_end(const RunSetup& setup, const std::string& key, Vec2 end) {
  const Vec2 p = end + setup.system.origin;
  refuse(key, fmt::format("[{:.6g}, {:.6g}], in no rock", p.x, p.y),
         "a point of rock that is there when the bolt is installed");
}

/// axis: direction, of length 1.
std::vector<BoltPiece> pieces_along(const RunSetup& setup, Vec2 from, Vec2 axis, double length, int staged) {
  const std::ptrdiff_t installed = installing_stage(setup, staged);
  std::vector<BoltPiece> pieces;
  std::vector<double> places;
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    if (is_gone(setup, b, installed)) continue;
    const Polygon& polygon = setup.system.blocks[b].polygon;
    places.clear();
    add_crossings(polygon.outer, from, axis, places);
    for (const Ring& hole : polygon.holes) add_crossings(hole, from, axis, places);
    std::ranges::sort(places);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2) {
      const BoltPiece piece{b, std::max(places[i], 0.0), std::min(places[i + 1], length)};
      if (piece.length() > least_share * length) pieces.push_back(piece);
    }
  }
  std::ranges::sort(pieces, {}, [](const BoltPiece& p) { return std::pair(p.from, p.block); });
  return pieces;
}

class BoltBuilder {
 public:
  BoltBuilder(const RunSetup& setup, const dynamics::Model& model, std::size_t k, BoltSprings& to)
      : bolt_(setup.bolts[k]), model_(model), pieces_(bolt_pieces(setup, k)), make_(bolt_, model, to) {}

  void build() {
    if (bolt_.is_anchored) return build_anchored();
    std::vector<std::size_t> joints;  // by the piece before
    for (std::size_t j = 0; j + 1 < pieces_.size(); ++j) {
      if (moves(j, j + 1) && at_joint(j, bolt_.has_plate).capacity > 0.0) joints.push_back(j);
    }
    for (std::size_t i = 0; i < joints.size(); ++i)
      build_joint(joints[i], joints.size() == 1 ? bolt_.name : fmt::format("{}.{}", bolt_.name, i + 1));
  }

 private:
  /// Whether the ends in two pieces can move against each other.
  [[nodiscard]] bool moves(std::size_t a, std::size_t b) const {
    const std::size_t of_a = pieces_[a].block, of_b = pieces_[b].block;
    return of_a != of_b && !(model_.blocks[of_a].fixed && model_.blocks[of_b].fixed);
  }
  /// Ends, and the stretch that it is drawn along: m from the head, in the blocks of two pieces.
  void add(dynamics::PointSpring spring, const BoltPiece& a, const BoltPiece& b,
           std::pair<double, double> ends, std::pair<double, double> drawn) const {
    make_.add(std::move(spring), ends, {make_.point(a, ends.first), make_.point(b, ends.second)},
              {make_.point(a, drawn.first), make_.point(b, drawn.second)});
  }

  void build_anchored() const {
    if (!moves(0, pieces_.size() - 1)) return;
    const double length = bolt_.length();
    dynamics::PointSpring spring = make_.spring_of("bolt", bolt_.name);
    make_.set_bar(spring, bolt_.bar() / length, bolt_.yield.value_or(HUGE_VAL), length);
    spring.pulls_only = true;
    add(spring, pieces_.front(), pieces_.back(), {0.0, length}, {0.0, length});
  }

  /// Of the joint behind piece j. What is between the pieces is free.
  [[nodiscard]] loading::BoltAtJoint at_joint(std::size_t j, bool has_plate) const {
    const auto [from, to] = bolt_.grouted;
    const double out = pieces_[j].to, in = std::max(pieces_[j + 1].from, out);
    const double head = std::max(std::min(to, out) - from, 0.0), toe = std::max(to - std::max(from, in), 0.0);
    return bolt_at_joint(bolt_, BoltSide(bolt_, head > 0.0 ? out - std::min(to, out) : out, head, has_plate),
                         BoltSide(bolt_, in - out + std::max(from - in, 0.0), toe, false));
  }

  void build_joint(std::size_t j, const std::string& name) const {
    const BoltPiece &a = pieces_[j], &b = pieces_[j + 1];
    const loading::BoltAtJoint joint = at_joint(j, bolt_.has_plate);
    const double half = 0.5 * bolt_.active_length;
    const std::pair drawn{j == 0 ? 0.0 : 0.5 * (a.from + a.to),
                          j + 2 == pieces_.size() ? bolt_.length() : 0.5 * (b.from + b.to)};
    dynamics::PointSpring bar = make_.spring_of("bolt", name);
    make_.set_bar(bar, joint.stiffness, joint.capacity, bolt_.active_length);
    // A plate holds the head that is pulled into the rock. A bar that is pushed out takes it along.
    bar.push = at_joint(j, false).capacity / bolt_.spacing;
    bar.pulls_only = bar.push == 0.0;
    const int number = make_.next();
    add(bar, a, b, {std::max(a.to - half, a.from), std::min(b.from + half, b.to)}, drawn);
    make_.add_dowel(number, name, a, b, drawn);
  }

  const Bolt& bolt_;
  const dynamics::Model& model_;
  std::vector<BoltPiece> pieces_;
  BoltSpringMaker make_;
};

}  // namespace

std::vector<BoltPiece> rock_along(const RunSetup& setup, Vec2 from, Vec2 to, int staged) {
  const double length = norm(to - from);
  return pieces_along(setup, from, (to - from) / length, length, staged);
}

std::vector<BoltPiece> bolt_pieces(const RunSetup& setup, std::size_t k) {
  const Bolt& bolt = setup.bolts[k];
  const double length = bolt.length();
  const Vec2 axis = axis_of(bolt), aside = aside_share * length * Vec2{-axis.y, axis.x};
  std::vector<BoltPiece> pieces = pieces_along(setup, bolt.head + aside, axis, length, bolt.staged);
  const std::string key = fmt::format("bolt[{}]", k);
  if (pieces.empty() || pieces.front().from > end_share * length) refuse_end(setup, key + ".from", bolt.head);
  if (pieces.back().to < (1.0 - end_share) * length) refuse_end(setup, key + ".to", bolt.toe);
  return pieces;
}

void add_bolts(const RunSetup& setup, const dynamics::Model& model, BoltSprings& to) {
  for (std::size_t k = 0; k < setup.bolts.size(); ++k) {
    if (!setup.bolts[k].has_nodes) BoltBuilder(setup, model, k, to).build();
  }
}

}  // namespace keyblock::simulation
