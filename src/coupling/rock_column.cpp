#include "coupling/rock_column.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "core/lanes.h"
#include "coupling/rock_column_system.h"

namespace keyblock::dynamics {

namespace {

constexpr double elements_of_a_wave = 40.0;
constexpr double plane_apart = 1e-6;  // of the height of the column: planes of one place
constexpr int parts_with_dip = 4;     // of a step, with planes that are not level
constexpr int least_elements = 20, most_elements = 4000;

enum Quantity : std::size_t { displacement, velocity, acceleration, force };

/// Where a quantity of a node stands in memory: x, and then y.
std::size_t place(Quantity quantity, std::size_t nodes, std::size_t node) {
  return 2 * (quantity * nodes + node);
}

Vec2 vector_at(std::span<const double> memory, std::size_t place) {
  return {memory[place], memory[place + 1]};
}

double along(Vec2 v, std::size_t axis) {
  return axis == 0 ? v.x : v.y;
}

/// The motion of a node, x in the first lane and y in the second.
Motion motion_at(std::span<const double> memory, std::size_t nodes, std::size_t node) {
  const auto both = [&](Quantity quantity) { return load_first(&memory[place(quantity, nodes, node)], 2); };
  return {both(velocity), both(acceleration), both(force)};
}

/// Of planes that are no farther apart than this, m, one remains: there is no rock between them that could move. planes: from below.
void keep_weakest_of_a_height(std::vector<RockPlane>& planes, double apart) {
  const auto strength = [](const RockPlane& p) { return p.cohesion + p.friction * std::max(0.0, p.normal); };
  std::vector<RockPlane> kept;
  for (const RockPlane& plane : planes) {
    if (kept.empty() || plane.height - kept.back().height > apart) {
      kept.push_back(plane);
    } else if (strength(plane) < strength(kept.back())) {
      kept.back() = plane;
    }
  }
  planes = std::move(kept);
}

/// Mean of the consistent and the lumped mass of an element of mass 1: of a node with itself, and with the other one.
constexpr double own_mass = 5.0 / 12.0, shared_mass = 1.0 / 12.0;

}  // namespace

Vec2 RockLayer::impedance() const {
  return {std::sqrt(density * shear), std::sqrt(density * upright)};
}

Vec2 RockLayer::speeds() const {
  return {std::sqrt(shear / density), std::sqrt(upright / density)};
}

const RockLayer& layer_at(std::span<const RockLayer> layers, double height) {
  std::size_t k = 0;
  while (k + 1 < layers.size() && height <= layers[k + 1].top) ++k;
  return layers[k];
}

RockColumn::RockColumn(std::span<const RockLayer> layers, double base, double ground,
                       std::optional<Vec2> dashpots, double fastest, ColumnDamping damping,
                       std::span<const RockPlane> planes)
    : layers_(layers.begin(), layers.end()),
      dashpots_(dashpots),
      damping_(damping),
      planes_(planes.begin(), planes.end()) {
  std::stable_sort(planes_.begin(), planes_.end(),
                   [](const RockPlane& a, const RockPlane& b) { return a.height < b.height; });
  std::erase_if(planes_, [&](const RockPlane& p) { return p.height <= base || p.height >= ground; });
  keep_weakest_of_a_height(planes_, plane_apart * (ground - base));
  height_.push_back(base);
  for (std::size_t k = layers_.size(); k-- > 0;) {
    const RockLayer& rock = layers_[k];
    const double bottom = height_.back(), top = k == 0 ? ground : std::min(rock.top, ground);
    if (top <= bottom) continue;
    const double slowest = std::sqrt(std::min(rock.shear, rock.upright) / rock.density),
                 longest =
                     std::min(slowest / (elements_of_a_wave * fastest), (ground - base) / least_elements);
    double from = bottom;
    // A plane at the end of a layer is the last thing in it.
    while (link_.size() < planes_.size() && planes_[link_.size()].height <= top) {
      const RockPlane& plane = planes_[link_.size()];
      add_elements(rock, from, plane.height, longest);
      from = plane.height;
      link_.push_back(density_.size());
      sideways_.push_back(rock.sideways / rock.upright);
      height_.push_back(from);
      density_.push_back(0.0);
      for (auto& modulus : modulus_) modulus.push_back(0.0);
    }
    if (from < top) add_elements(rock, from, top, longest);
  }
}

void RockColumn::add_elements(const RockLayer& rock, double bottom, double top, double longest) {
  const int count = std::clamp(static_cast<int>(std::ceil((top - bottom) / longest)), 1, most_elements);
  for (int i = 1; i <= count; ++i) {
    height_.push_back(std::lerp(bottom, top, static_cast<double>(i) / count));
    density_.push_back(rock.density);
    modulus_[0].push_back(rock.shear);
    modulus_[1].push_back(rock.upright);
  }
}

/// M (c (D/Δt − v)/Δt − c_a a − c_F F) = −ρ a_frame − K (u + D + β D/Δt) − C v′(D), see Integrator.
void RockColumn::step(std::span<const double> before, double dt, const Integrator& rule, Vec2 frame,
                      std::span<double> after) const {
  const int parts = has_dipping_planes() ? parts_with_dip : 1;
  step_once(before, dt / parts, rule, frame, after);
  for (int k = 1; k < parts; ++k) step_once(after, dt / parts, rule, frame, after);
}

void RockColumn::step_once(std::span<const double> before, double dt, const Integrator& rule, Vec2 frame,
                           std::span<double> after) const {
  const std::size_t n = height_.size();
  // What D = 0 would end with.
  std::vector<Motion> coasting(n);
  for (std::size_t k = 0; k < n; ++k) coasting[k] = rule.end(motion_at(before, n, k), Lanes{}, dt);
  Tridiagonal systems[] = {Tridiagonal(n), Tridiagonal(n)};
  for (const int axis : {0, 1}) {
    Tridiagonal& system = systems[axis];
    assemble(before, coasting, at(axis),
             {.inertia = rule.inertia() / (dt * dt),
              .drag = damping_.drag * rule.end_velocity_share() / dt,
              .viscous = 1.0 + damping_.viscosity / dt},
             along(frame, at(axis)), system);
    if (dashpots_) {
      const double dashpot = along(*dashpots_, at(axis));
      system.diagonal[0] += dashpot * rule.end_velocity_share() / dt;
      system.right[0] -= dashpot * coasting[0].velocity[axis];
    } else {
      system.diagonal[0] = 1.0;
      system.right[0] = system.beside[0] = 0.0;
    }
  }
  if (planes_.empty()) {
    for (Tridiagonal& system : systems) system.solve();
  } else {
    solve_planes(before, systems, after);
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double d[] = {systems[0].right[k], systems[1].right[k]};
    const Motion end = rule.end(motion_at(before, n, k), load_first(d, 2), dt);
    const Vec2 u = vector_at(before, place(displacement, n, k));
    after[place(displacement, n, k)] = u.x + d[0];
    after[place(displacement, n, k) + 1] = u.y + d[1];
    store_first(&after[place(velocity, n, k)], end.velocity, 2);
    store_first(&after[place(acceleration, n, k)], end.acceleration, 2);
    store_first(&after[place(force, n, k)], end.force, 2);
  }
}

/// What elements do: inertia, stiffness, and the body force in the acceleration of the frame.
void RockColumn::assemble(std::span<const double> before, std::span<const Motion> coasting, std::size_t axis,
                          const StepFactors& factors, double frame, Tridiagonal& system) const {
  const std::size_t n = height_.size();
  const double of_mass = factors.inertia + factors.drag;
  const auto owed = [&](std::size_t k) {
    const int lane = static_cast<int>(axis);
    return -coasting[k].force[lane] - damping_.drag * coasting[k].velocity[lane];
  };
  for (std::size_t e = 0; e + 1 < n; ++e) {
    if (is_link(e)) continue;
    const double length = height_[e + 1] - height_[e], mass = density_[e] * length,
                 stiffness = modulus_[axis][e] / length,
                 pull = stiffness * (before[place(displacement, n, e + 1) + axis] -
                                     before[place(displacement, n, e) + axis]);
    for (const std::size_t k : {e, e + 1}) {
      const std::size_t other = k == e ? e + 1 : e;
      system.diagonal[k] += own_mass * mass * of_mass + factors.viscous * stiffness;
      system.right[k] +=
          mass * (own_mass * owed(k) + shared_mass * owed(other) - 0.5 * frame) + (k == e ? pull : -pull);
    }
    system.beside[e] = shared_mass * mass * of_mass - factors.viscous * stiffness;
  }
}

std::size_t RockColumn::next_above(std::size_t element) const {
  do ++element;
  while (element < density_.size() && is_link(element));
  return element;
}

RockColumn::Place RockColumn::place_of(double height) const {
  const auto above = std::upper_bound(height_.begin() + 1, height_.end() - 1, height);
  Place p;
  p.element = static_cast<std::size_t>(above - height_.begin()) - 1;
  const double from = height_[p.element], to = height_[p.element + 1];
  p.share = std::clamp((height - from) / (to - from), 0.0, 1.0);
  // Stress is known in the middle of elements, and at the ground. Below the middle of the lowest element it goes on as above.
  // The stress is the same on both sides of a plane.
  std::size_t below = p.element;
  while (below > 0 && is_link(below - 1)) --below;
  p.stressed = p.share < 0.5 && below > 0 ? below - 1 : p.element;
  const auto middle = [&](std::size_t e) { return 0.5 * (height_[e] + height_[e + 1]); };
  const std::size_t over = next_above(p.stressed);
  const double low = middle(p.stressed), high = over + 1 < height_.size() ? middle(over) : height_.back();
  p.stress_share = std::min((height - low) / (high - low), 1.0);
  const RockLayer& rock = layer_at(layers_, height);
  p.sideways = rock.sideways / rock.upright;
  return p;
}

Vec2 RockColumn::at_place(std::span<const double> of_nodes, const Place& p) const {
  return lerp(vector_at(of_nodes, 2 * p.element), vector_at(of_nodes, 2 * (p.element + 1)), p.share);
}

GroundMove RockColumn::motion(std::span<const double> memory, const Place& p) const {
  const std::size_t n = height_.size();
  return {at_place(memory.subspan(place(displacement, n, 0), 2 * n), p),
          at_place(memory.subspan(place(velocity, n, 0), 2 * n), p)};
}

std::vector<double> RockColumn::strained(std::span<const double> before, double dt,
                                         std::span<const double> after) const {
  const std::span<const double> from = displacements(before), to = displacements(after);
  std::vector<double> of_nodes(to.begin(), to.end());
  for (std::size_t k = 0; k < of_nodes.size() && damping_.viscosity > 0.0; ++k)
    of_nodes[k] += damping_.viscosity / dt * (to[k] - from[k]);
  return of_nodes;
}

/// Between the places where stress is known it is linear: τ and σ_yy are the same on both sides of a layer's end.
RockColumn::Stress RockColumn::stress(std::span<const double> strained, const Place& p) const {
  const auto of_element = [&](std::size_t e) {
    const Vec2 strain =
        (vector_at(strained, 2 * (e + 1)) - vector_at(strained, 2 * e)) / (height_[e + 1] - height_[e]);
    return Vec2{modulus_[0][e] * strain.x, modulus_[1][e] * strain.y};
  };
  const std::size_t next = next_above(p.stressed);
  const bool at_ground = next + 1 == height_.size();
  const Vec2 on_level = lerp(of_element(p.stressed), at_ground ? Vec2{} : of_element(next), p.stress_share);
  return {p.sideways * on_level.y, on_level.y, on_level.x};
}

}  // namespace keyblock::dynamics
