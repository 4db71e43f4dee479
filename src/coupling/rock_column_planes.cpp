#include <algorithm>
#include <cmath>

#include "coupling/rock_column.h"
#include "coupling/rock_column_system.h"

namespace keyblock::dynamics {

namespace {

constexpr int most_rounds = 60;      // of states in a solution
constexpr int most_solutions = 200;  // of both axes, until slip stays
constexpr double steady = 1e-10;     // of the largest slip, m: slip that stays

/// Of the memory of a plane: slip along x in the waves at hand, slip before them, the largest, whether it is broken, has opened, τ, σ.
enum Number : std::size_t { slip_in_x, slip_before, largest, broken, opened, shear, upright };

}  // namespace

/// A plane in a step. Displacements along y are those of the rock less what its slip lifts.
struct RockColumn::Link {
  std::size_t below = 0;           ///< the node below it, and the element that it is
  Vec2 jump;                       ///< m, at the start of the step
  double slip = 0.0;               ///< m, along x
  double sigma = 0.0;              ///< Pa, at the end
  double least = 0.0, most = 0.0;  ///< Pa, bounds of τ
  int state = 0;                   ///< y: 1 is open; x: ±1 slips
  bool is_open = false;
  [[nodiscard]] double bound() const { return state > 0 ? most : least; }  ///< Pa, of one that slips
};

/// The solution of a step with planes.
class RockColumn::Slide {
 public:
  Slide(const RockColumn& column, std::span<const double> before, std::span<Tridiagonal> systems)
      : column_(column),
        memory_(before.subspan(column.memory_of_nodes(), numbers_of_plane * column.planes_.size())),
        systems_(systems),
        tau_(column.planes_.size(), 0.0) {
    for (std::size_t j = 0; j < column.planes_.size(); ++j) {
      const std::size_t k = column.link_[j];
      const auto at_node = [&](std::size_t node) { return Vec2{before[2 * node], before[2 * node + 1]}; };
      Link link;
      link.below = k;
      link.jump = at_node(k + 1) - at_node(k);
      link.slip = number(j, slip_in_x);
      links_.push_back(link);
    }
  }

  /// The increments of the nodes in the right sides of the systems; the planes in their memory. What the slip still changes by after
  /// most_solutions is missing in what lifts the rock in this step; the next one begins with it.
  void solve(std::span<double> after) {
    std::vector<double> x, y;
    double change = 0.0, size = 0.0;
    for (int k = 0; k < most_solutions; ++k) {
      y = solve_upright();
      change = size = 0.0;
      x = solve_shear(change, size);
      if (!column_.has_dipping_planes() || change <= steady * size) break;
    }
    systems_[0].right = std::move(x);
    systems_[1].right = std::move(y);
    write(after.subspan(column_.memory_of_nodes()));
  }

 private:
  [[nodiscard]] double number(std::size_t j, Number of) const { return memory_[numbers_of_plane * j + of]; }
  [[nodiscard]] bool is_broken(std::size_t j) const { return number(j, broken) != 0.0; }
  [[nodiscard]] double tension(std::size_t j) const {
    return is_broken(j) ? 0.0 : column_.planes_[j].tension;
  }
  /// m, what slip lowers the upper rock by.
  [[nodiscard]] double lowered(std::size_t j) const {
    return links_[j].slip * std::tan(column_.planes_[j].dip);
  }

  /// A solution with links as they are: a spring of stiffness k that has a force at D = 0, or a force alone.
  template <typename SpringOf>
  std::vector<double> solve_with(const Tridiagonal& chain, const SpringOf& spring_of) const {
    Tridiagonal system = chain;
    for (std::size_t j = 0; j < links_.size(); ++j) {
      const auto [stiffness, force] = spring_of(j);
      const std::size_t below = links_[j].below, above = below + 1;
      system.diagonal[below] += stiffness;
      system.diagonal[above] += stiffness;
      system.beside[below] -= stiffness;
      system.right[below] += force;
      system.right[above] -= force;
    }
    system.solve();
    return std::move(system.right);
  }
  [[nodiscard]] static double jump_of(const std::vector<double>& d, const Link& link) {
    return d[link.below + 1] - d[link.below];
  }

  std::vector<double> solve_upright() {
    const auto most = [&](std::size_t j) { return column_.planes_[j].level + tension(j); };
    for (Link& link : links_) link.state = 0;
    std::vector<double> d;
    for (int round = 0; round < most_rounds; ++round) {
      d = solve_with(systems_[1], [&](std::size_t j) -> std::pair<double, double> {
        const double k = column_.planes_[j].normal_stiffness;
        if (links_[j].state != 0) return {0.0, column_.planes_[j].level};
        return {k, k * (links_[j].jump.y + lowered(j))};
      });
      bool changes = false;
      for (std::size_t j = 0; j < links_.size(); ++j) {
        Link& link = links_[j];
        const double sigma =
            column_.planes_[j].normal_stiffness * (link.jump.y + lowered(j) + jump_of(d, link));
        const int state = sigma > most(j) ? 1 : 0;
        changes |= state != link.state;
        link.state = state;
        link.sigma = state != 0 ? column_.planes_[j].level : sigma;
      }
      if (!changes) break;
    }
    for (std::size_t j = 0; j < links_.size(); ++j) {
      links_[j].is_open = links_[j].state != 0;
      bound(j);
    }
    return d;
  }

  /// |T⁰ + S + τ cos 2α| ≤ c + (N − τ sin 2α) tan φ, with S and N of σ.
  void bound(std::size_t j) {
    const RockPlane& plane = column_.planes_[j];
    Link& link = links_[j];
    const double s = std::sin(plane.dip), c = std::cos(plane.dip), r = column_.sideways_[j],
                 turned = c * c - s * s, twice = 2.0 * s * c,
                 along = plane.shear + 0.5 * twice * (r - 1.0) * link.sigma;
    if (link.is_open) {
      link.least = link.most = -along / turned;
      return;
    }
    const double normal = plane.normal - link.sigma * (r * s * s + c * c),
                 strength = std::max(0.0, (is_broken(j) ? 0.0 : plane.cohesion) + plane.friction * normal);
    link.most = (strength - along) / (turned + twice * plane.friction);
    link.least = -(strength + along) / (turned - twice * plane.friction);
  }

  std::vector<double> solve_shear(double& change, double& size) {
    for (Link& link : links_) link.state = 0;
    std::vector<double> d;
    for (int round = 0; round < most_rounds; ++round) {
      d = solve_with(systems_[0], [&](std::size_t j) -> std::pair<double, double> {
        const Link& link = links_[j];
        if (link.state != 0) return {0.0, link.bound()};
        return {column_.planes_[j].shear_stiffness, held(j)};
      });
      if (!change_shear_states(d)) break;
    }
    for (std::size_t j = 0; j < links_.size(); ++j) {
      Link& link = links_[j];
      const double stiffness = column_.planes_[j].shear_stiffness, jump = link.jump.x + jump_of(d, link),
                   slip = link.state == 0 ? number(j, slip_in_x) : jump - link.bound() / stiffness;
      change = std::max(change, std::abs(slip - link.slip));
      size = std::max(size, std::abs(slip));
      link.slip = slip;
      tau_[j] = stiffness * (jump - slip);
    }
    return d;
  }

  /// Pa, τ at D = 0 of a plane that does not slip.
  [[nodiscard]] double held(std::size_t j) const {
    return column_.planes_[j].shear_stiffness * (links_[j].jump.x - number(j, slip_in_x));
  }
  /// By the bounds that a solution goes beyond. Whether any state is another.
  bool change_shear_states(const std::vector<double>& d) {
    bool changes = false;
    for (std::size_t j = 0; j < links_.size(); ++j) {
      Link& link = links_[j];
      const double tau = held(j) + column_.planes_[j].shear_stiffness * jump_of(d, link);
      const int state = tau > link.most ? 1 : tau < link.least ? -1 : 0;
      changes |= state != link.state;
      link.state = state;
    }
    return changes;
  }

  void write(std::span<double> memory) const {
    for (std::size_t j = 0; j < links_.size(); ++j) {
      const RockPlane& plane = column_.planes_[j];
      const Link& link = links_[j];
      const std::span<double> m = memory.subspan(numbers_of_plane * j, numbers_of_plane);
      std::ranges::copy(memory_.subspan(numbers_of_plane * j, numbers_of_plane), m.begin());
      if (link.slip != number(j, slip_in_x) || link.is_open) m[broken] = 1.0;
      if (link.is_open) m[opened] = 1.0;
      m[slip_in_x] = link.slip;
      m[largest] = std::max(m[largest], std::abs(m[slip_before] + link.slip) / std::cos(plane.dip));
      m[shear] = tau_[j];
      m[upright] = link.sigma;
    }
  }

  const RockColumn& column_;
  std::span<const double> memory_;
  std::span<Tridiagonal> systems_;
  std::vector<Link> links_;
  std::vector<double> tau_;
};

bool RockColumn::has_dipping_planes() const {
  return std::ranges::any_of(planes_, [](const RockPlane& p) { return p.dip != 0.0; });
}

void RockColumn::solve_planes(std::span<const double> before, std::span<Tridiagonal> systems,
                              std::span<double> after) const {
  Slide(*this, before, systems).solve(after);
}

RockPlaneState RockColumn::plane(std::span<const double> memory, std::size_t k) const {
  const RockPlane& plane = planes_[k];
  const double* m = &memory[memory_of_nodes() + numbers_of_plane * k];
  const double s = std::sin(plane.dip), c = std::cos(plane.dip), r = sideways_[k];
  return {.slip = (m[slip_before] + m[slip_in_x]) / c,
          .largest_slip = m[largest],
          .normal = plane.normal - m[upright] * (r * s * s + c * c) - 2.0 * s * c * m[shear],
          .shear = plane.shear + m[shear] * (c * c - s * s) + (r - 1.0) * m[upright] * s * c,
          .broken = m[broken] != 0.0,
          .opened = m[opened] != 0.0};
}

void RockColumn::rest(std::span<double> memory, std::span<double> moved) const {
  const std::span<const double> now = displacements(memory);
  for (std::size_t k = 0; k < now.size(); ++k) moved[k] += now[k];
  const std::size_t nodes = memory_of_nodes();
  std::fill_n(memory.begin(), nodes, 0.0);
  for (std::size_t k = 0; k < planes_.size(); ++k) {
    const std::span<double> m = memory.subspan(nodes + numbers_of_plane * k, numbers_of_plane);
    m[slip_before] += m[slip_in_x];
    m[slip_in_x] = m[shear] = m[upright] = 0.0;
  }
}

}  // namespace keyblock::dynamics
