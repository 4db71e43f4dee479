#include "simulation/bolt_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/index.h"
#include "simulation/build_bolts.h"

namespace keyblock::simulation {

namespace {

using loading::Bolt;

constexpr double bar_density = 7850.0;  // kg/m³
constexpr double longest_spacing = 0.25, shares_of_decay = 2.0;
constexpr double hole_factor =
    10.0;  // the rock about a bar is so much stiffer across it than grout is along it
constexpr double least_grout = 1e-6;  // of the length of a bolt

/// The grout in one block, in cells with a node in the middle of each: one of a given width beside each joint, the others evenly.
struct Stretch {
  std::size_t piece = 0;
  double from = 0.0, to = 0.0;           ///< m from the head
  double at_first = 0.0, at_last = 0.0;  ///< m, width of the cell at a joint; 0: there is none
  int others = 0;

  /// m, of the other cells.
  [[nodiscard]] double width() const { return (to - from - at_first - at_last) / std::max(others, 1); }
  [[nodiscard]] int cells() const { return others + (at_first > 0.0 ? 1 : 0) + (at_last > 0.0 ? 1 : 0); }
  void add_cells(std::vector<BoltNode>& nodes) const {
    double place = from;
    const auto add = [&](double next) {
      nodes.push_back({piece, place, next});
      place = next;
    };
    if (at_first > 0.0) add(from + at_first);
    for (int i = 1; i <= others; ++i) add(i == others && at_last == 0.0 ? to : from + at_first + i * width());
    if (at_last > 0.0) add(to);
  }
};

class BoltDivider {
 public:
  BoltDivider(const Bolt& bolt, const std::vector<BoltPiece>& pieces, int whole)
      : bolt_(bolt), pieces_(pieces), whole_(whole) {}

  std::vector<BoltNode> divide() {
    for (std::size_t j = 0; j < pieces_.size(); ++j) add_stretch(j);
    if (stretches_.empty() || (stretches_.size() == 1 && (stretches_[0].piece == 0 || !bolt_.has_plate)))
      return {};
    const int plates = bolt_.has_plate ? 1 : 0;
    int count = plates;
    for (const Stretch& s : stretches_) count += s.cells();
    for (; count % whole_ != 0; ++count) ++std::ranges::max_element(stretches_, {}, &Stretch::width)->others;
    std::vector<BoltNode> nodes;
    if (bolt_.has_plate) nodes.push_back({});
    for (const Stretch& s : stretches_) s.add_cells(nodes);
    return nodes;
  }

 private:
  void add_stretch(std::size_t j) {
    const auto [grout_from, grout_to] = bolt_.grouted;
    const BoltPiece& piece = pieces_[j];
    Stretch s{.piece = j, .from = std::max(piece.from, grout_from), .to = std::min(piece.to, grout_to)};
    const double length = s.to - s.from, most = node_spacing(bolt_);
    if (length <= least_grout * bolt_.length()) return;
    const double at_joint = std::min(bolt_.active_length, most);
    const bool joint_before = j > 0 && s.from == piece.from,
               joint_after = j + 1 < pieces_.size() && s.to == piece.to;
    // In a short stretch all cells are alike.
    if (length > 3.0 * at_joint) {
      s.at_first = joint_before ? at_joint : 0.0;
      s.at_last = joint_after ? at_joint : 0.0;
    }
    s.others = std::max(1, static_cast<int>(std::ceil(s.width() / most - 1e-9)));
    stretches_.push_back(s);
  }

  const Bolt& bolt_;
  const std::vector<BoltPiece>& pieces_;
  int whole_;
  std::vector<Stretch> stretches_;
};

/// Where node i is: which body of its bolt, and which node of it.
std::pair<int, int> place_of_node(std::size_t i, int size) {
  const int node = static_cast<int>(i), group = node / (2 * size), in_group = node % (2 * size);
  return {2 * group + in_group % 2, in_group / 2};
}

/// m of bar that node i stands for.
double length_of_node(const std::vector<BoltNode>& nodes, std::size_t i) {
  const double before = i == 0 ? 0.0 : nodes[i].middle() - nodes[i - 1].middle(),
               after = i + 1 == nodes.size() ? 0.0 : nodes[i + 1].middle() - nodes[i].middle();
  return 0.5 * (before + after);
}

double area_of_node(const Bolt& bolt, const std::vector<BoltNode>& nodes, std::size_t i) {
  return bolt.area / bolt.spacing * length_of_node(nodes, i);
}

/// Of the blocks of a bolt that move, the heaviest.
int heaviest_block(const RunSetup& setup, const std::vector<BoltPiece>& pieces) {
  int heaviest = -1;
  double most = 0.0;
  for (const BoltPiece& piece : pieces) {
    const BlockProperties& properties = setup.properties[piece.block];
    if (properties.fixed) continue;
    const double mass = properties.material.density * area(setup.system.blocks[piece.block].polygon);
    if (mass <= most) continue;
    most = mass;
    heaviest = static_cast<int>(piece.block);
  }
  return heaviest;
}

/// N/m, of the grout about a node. A long chain of cells of length c, each two halves of bar with a spring k between them, gives way at its end by
/// √(c²/4 + EA c/k)/EA, and continuous grout by 1/(EA α): they are the same for k = k_b c/(1 − (α c)²/4).
double stiffness_of_node(const Bolt& bolt, double length) {
  constexpr double most = 1.0;  // (α c)², of a chain that is near enough to grout
  const double squared = std::min(bolt.grout_stiffness / bolt.bar() * length * length, most);
  return bolt.grout_stiffness * length / (1.0 - 0.25 * squared);
}

class NodeBoltBuilder {
 public:
  NodeBoltBuilder(const RunSetup& setup, const dynamics::Model& model, std::size_t k, std::size_t first_body,
                  BoltSprings& to)
      : bolt_(setup.bolts[k]),
        pieces_(bolt_pieces(setup, k)),
        nodes_(bolt_nodes(setup, k)),
        size_(body_size(setup)),
        first_body_(first_body),
        make_(bolt_, model, to) {}

  [[nodiscard]] std::size_t bodies() const { return nodes_.size() / at(size_); }

  void build() {
    first_bar_ = make_.next();
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) build_bar(i);
    first_hole_ = make_.next();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].grouted() > 0.0) {
        build_grout(i);
      } else {
        build_plate();
      }
    }
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
      for (std::size_t j = nodes_[i].piece; j < nodes_[i + 1].piece; ++j) build_dowel(i, j);
    }
  }

 private:
  [[nodiscard]] dynamics::MaterialPoint node(std::size_t i) const {
    const auto [body, local] = place_of_node(i, size_);
    dynamics::MaterialPoint point{static_cast<int>(first_body_) + body, std::vector<double>(at(size_))};
    point.phi[at(local)] = 1.0 / std::sqrt(area_of_node(bolt_, nodes_, i));
    return point;
  }
  [[nodiscard]] int block_of(std::size_t i) const { return static_cast<int>(pieces_[nodes_[i].piece].block); }
  [[nodiscard]] bool crosses_joint(std::size_t i) const { return nodes_[i].piece != nodes_[i + 1].piece; }
  /// Bars at joints have the names that springs at joints have.
  [[nodiscard]] std::string name_of_bar(std::size_t i) const {
    if (!crosses_joint(i)) return fmt::format("{}.bar.{}", bolt_.name, i + 1);
    std::size_t number = 1, joints = 0;
    for (std::size_t j = 0; j + 1 < nodes_.size(); ++j) {
      joints += crosses_joint(j) ? 1 : 0;
      number += j < i && crosses_joint(j) ? 1 : 0;
    }
    return joints == 1 ? bolt_.name : fmt::format("{}.{}", bolt_.name, number);
  }
  /// The bar beside a node that gives the direction of its hole, by number: one in the same block, where there is one.
  [[nodiscard]] int bar_beside(std::size_t i) const {
    const bool has_next = i + 1 < nodes_.size();
    const bool is_next = i == 0 || (has_next && (!crosses_joint(i) || crosses_joint(i - 1)));
    return first_bar_ + static_cast<int>(is_next ? i : i - 1);
  }

  void build_bar(std::size_t i) const {
    const double from = nodes_[i].middle(), to = nodes_[i + 1].middle(), length = to - from;
    dynamics::PointSpring bar = make_.spring_of("bolt", name_of_bar(i));
    // A bar that yields between nodes near each other is strained beyond them.
    make_.set_bar(bar, bolt_.bar() / length, bolt_.yield.value_or(HUGE_VAL),
                  std::max(length, bolt_.active_length));
    bar.in = {block_of(i), block_of(i + 1)};
    make_.add(std::move(bar), {from, to}, {node(i), node(i + 1)}, {node(i), node(i + 1)});
  }

  /// A spring from a node to its hole.
  [[nodiscard]] dynamics::PointSpring hold_of(const char* kind, std::string name, std::size_t i,
                                              double stiffness) const {
    dynamics::PointSpring spring = make_.spring_of(kind, std::move(name));
    spring.stiffness = stiffness / bolt_.spacing;
    spring.yield = HUGE_VAL;
    spring.along = bar_beside(i);
    spring.in = {block_of(i), block_of(i)};
    return spring;
  }
  void build_grout(std::size_t i) const {
    const BoltNode& n = nodes_[i];
    dynamics::PointSpring grout = hold_of("grout", fmt::format("{}.grout.{}", bolt_.name, i + 1), i,
                                          stiffness_of_node(bolt_, n.grouted()));
    if (bolt_.grout_strength) grout.yield = *bolt_.grout_strength * n.grouted() / bolt_.spacing;
    grout.hold = hole_factor * grout.stiffness;
    const BoltPiece& piece = pieces_[n.piece];
    make_.add(std::move(grout), {n.middle(), n.middle()}, {node(i), make_.point(piece, n.middle())},
              {make_.point(piece, n.from), make_.point(piece, n.to)});
  }
  /// Washer, nut and thread give way as the active length of the bar does.
  void build_plate() const {
    dynamics::PointSpring plate =
        hold_of("plate", bolt_.name + ".plate", 0, bolt_.bar() / bolt_.active_length);
    plate.pulls_only = true;
    plate.hold = plate.stiffness;
    const auto in_rock = make_.point(pieces_[0], 0.0);
    make_.add(std::move(plate), {0.0, 0.0}, {node(0), in_rock}, {in_rock, in_rock});
  }
  void build_dowel(std::size_t i, std::size_t j) const {
    const BoltPiece &a = pieces_[j], &b = pieces_[j + 1];
    const double half = 0.5 * bolt_.active_length;
    const bool is_first = j == nodes_[i].piece;
    const int hole = first_hole_ + static_cast<int>(i);
    make_.add_dowel(first_bar_ + static_cast<int>(i),
                    is_first ? name_of_bar(i) : fmt::format("{}+{}", name_of_bar(i), j - nodes_[i].piece), a,
                    b, {std::max(a.to - half, a.from), std::min(b.from + half, b.to)},
                    {is_first ? hole : -1, j + 1 == nodes_[i + 1].piece ? hole + 1 : -1});
  }

  const Bolt& bolt_;
  std::vector<BoltPiece> pieces_;
  std::vector<BoltNode> nodes_;
  int size_, first_bar_ = 0, first_hole_ = 0;
  std::size_t first_body_;
  BoltSpringMaker make_;
};

}  // namespace

int body_size(const RunSetup& setup) {
  const bool is_order_2 = std::ranges::all_of(setup.properties, [](const BlockProperties& p) {
    return p.fixed || (p.order == 2 && !p.automatic_order);
  });
  return is_order_2 ? 6 : 3;
}

double node_spacing(const Bolt& bolt) {
  const double by_grout = std::sqrt(bolt.bar() / bolt.grout_stiffness) / shares_of_decay;
  return bolt.node_spacing.value_or(
      std::clamp(by_grout, std::min(bolt.diameter(), longest_spacing), longest_spacing));
}

std::vector<BoltNode> bolt_nodes(const RunSetup& setup, std::size_t k) {
  const Bolt& bolt = setup.bolts[k];
  if (!bolt.has_nodes) return {};
  const std::vector<BoltPiece> pieces = bolt_pieces(setup, k);
  if (heaviest_block(setup, pieces) < 0) return {};
  return BoltDivider(bolt, pieces, 2 * body_size(setup)).divide();
}

std::vector<dynamics::LineBody> bolt_lines(const RunSetup& setup) {
  std::vector<dynamics::LineBody> lines;
  for (std::size_t k = 0; k < setup.bolts.size(); ++k) {
    const std::vector<BoltNode> nodes = bolt_nodes(setup, k);
    if (nodes.empty()) continue;
    dynamics::LineBody line;
    line.size = body_size(setup);
    line.material.density = bar_density;
    line.material.young = setup.bolts[k].young;
    line.block = heaviest_block(setup, bolt_pieces(setup, k));
    const std::size_t first = lines.size();
    lines.resize(first + nodes.size() / at(line.size), line);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      lines[first + at(place_of_node(i, line.size).first)].area += area_of_node(setup.bolts[k], nodes, i);
  }
  return lines;
}

void add_bolts_of_nodes(const RunSetup& setup, const dynamics::Model& model, BoltSprings& to) {
  std::size_t next = model.blocks.size();
  for (std::size_t k = 0; k < setup.bolts.size(); ++k) {
    if (!setup.bolts[k].has_nodes) continue;
    NodeBoltBuilder builder(setup, model, k, next, to);
    builder.build();
    next += builder.bodies();
  }
}

}  // namespace keyblock::simulation
