#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "coupling/point_springs.h"
#include "dynamics/energy.h"
#include "geometry/polygon.h"
#include "model/vertex_field.h"
#include "simulation/control.h"
#include "simulation/refuse.h"
#include "simulation/setup.h"

// Forces and springs of a running model.
namespace keyblock::simulation {
namespace {

using dynamics::Block;
using dynamics::PointSprings;

// Of the radius of a block.
constexpr double place_tolerance = 1e-9, edge_tolerance = 1e-6;

double distance_from_ring(const Ring& ring, Vec2 p) {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], along = ring[(k + 1) % ring.size()] - a;
    const double share = std::clamp(dot(p - a, along) / std::max(dot(along, along), 1e-300), 0.0, 1.0);
    least = std::min(least, norm(p - (a + share * along)));
  }
  return least;
}

bool is_on_block(const Block& block, Vec2 p) {
  if (lies_in(block.reference, p)) return true;
  double least = distance_from_ring(block.reference.outer, p);
  for (const Ring& hole : block.reference.holes) least = std::min(least, distance_from_ring(hole, p));
  return least <= edge_tolerance * block.radius;
}

/// Where a point of a block was before the run, from where it is: Newton's method on x(X) = Σ φ_k(X) a_k.
std::optional<Vec2> reference_of(const Block& block, const double* coefficients, Vec2 place) {
  std::vector<double> phi(at(block.size));
  std::vector<Vec2> gradient(at(block.size));
  Vec2 at_reference = block.centroid;
  constexpr int most_iterations = 50;
  for (int k = 0; k < most_iterations; ++k) {
    block.basis.evaluate(at_reference, phi.data());
    const Vec2 miss = place - dynamics::field_at(phi.data(), block.size, coefficients);
    if (norm(miss) <= place_tolerance * block.radius) return at_reference;
    block.basis.gradients(at_reference, gradient.data());
    double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;  // ∂x/∂X
    for (std::size_t i = 0; i < phi.size(); ++i) {
      xx += coefficients[2 * i] * gradient[i].x;
      xy += coefficients[2 * i] * gradient[i].y;
      yx += coefficients[2 * i + 1] * gradient[i].x;
      yy += coefficients[2 * i + 1] * gradient[i].y;
    }
    const double determinant = xx * yy - xy * yx;
    if (!(std::abs(determinant) > 0.0)) return {};
    at_reference +=
        Vec2{(yy * miss.x - xy * miss.y) / determinant, (xx * miss.y - yx * miss.x) / determinant};
    if (!(norm(at_reference - block.centroid) <= 2.0 * block.radius)) return {};
  }
  return {};
}

dynamics::GeneralizedLoad load_of(const AppliedForce& applied, const dynamics::Model& model) {
  const Block& block = model.blocks[static_cast<std::size_t>(applied.block)];
  std::vector<double> phi(at(block.size));
  block.basis.evaluate(applied.point, phi.data());
  dynamics::GeneralizedLoad load{
      static_cast<int>(applied.block), std::vector<double>(2 * at(block.size), 0.0), {}};
  dynamics::add_at(phi.data(), block.size, applied.force, load.force.data());
  return load;
}

/// The springs between points, and their place among the couplings; null where there are none.
const PointSprings* springs_of(const dynamics::Model& model, std::size_t& place) {
  for (place = 0; place < model.couplings.size(); ++place) {
    if (const auto* springs = dynamic_cast<const PointSprings*>(model.couplings[place].get())) return springs;
  }
  return nullptr;
}

}  // namespace

std::size_t spring_count(const dynamics::Model& model) {
  std::size_t place = 0;
  const PointSprings* springs = springs_of(model, place);
  return springs == nullptr ? 0 : springs->springs().size();
}

void put_loads(const ControlMemory& memory, const RunSetup& setup, dynamics::Model& model) {
  model.loads.resize(setup.loads.size());
  for (const AppliedForce& force : memory.forces) model.loads.push_back(load_of(force, model));
  model.load_scale = memory.load_scale;
  if (!model.load_scale.empty()) model.load_scale.resize(model.loads.size(), 1.0);
}

void Control::set_force(std::size_t block, std::int64_t slot, std::optional<Vec2> place, Vec2 force) {
  if (block >= model_.blocks.size())
    refuse("block", std::to_string(block), "a block, less than " + std::to_string(model_.blocks.size()));
  if (!model_.moves(block)) refuse("block", std::to_string(block), "a block that is there and not fixed");
  if (!std::isfinite(norm(force)) || (place && !std::isfinite(norm(*place))))
    refuse("force", fmt::format("({}, {})", force.x, force.y), "finite numbers");
  const Block& of = model_.blocks[block];
  const auto reference =
      place ? reference_of(of, &state_.position[of.first], *place) : std::optional(of.centroid);
  if (!reference || !is_on_block(of, *reference))
    refuse("point", fmt::format("({}, {})", place->x, place->y),
           fmt::format("a point of block {} as it lies now", block));
  std::erase_if(memory_.forces, [&](const AppliedForce& f) {
    return f.block == static_cast<std::int64_t>(block) && f.slot == slot;
  });
  if (force != Vec2{}) memory_.forces.push_back({static_cast<std::int64_t>(block), slot, *reference, force});
  put_loads(memory_, setup_, model_);
}

std::vector<SpringNow> Control::springs() const {
  std::size_t place = 0;
  const PointSprings* springs = springs_of(model_, place);
  std::vector<SpringNow> all;
  if (springs == nullptr) return all;
  const auto now = springs->now(model_, state_, state_.couplings[place]);
  for (std::size_t k = 0; k < now.size(); ++k)
    all.push_back({k < setup_.springs.size() ? setup_.springs[k].name : springs->springs()[k].name,
                   now[k].from, now[k].to, now[k].length, now[k].stiffness, now[k].force,
                   springs->springs()[k].yield, now[k].is_there});
  return all;
}

void Control::check_spring(std::size_t spring) const {
  if (spring >= spring_count(model_))
    refuse("spring", std::to_string(spring),
           "the number of a spring, less than " + std::to_string(spring_count(model_)));
}

template <class Change>
void Control::with_input(const Change& change) {
  const double before = dynamics::support_energy(model_, state_, state_.time);
  change();
  const double by = dynamics::support_energy(model_, state_, state_.time) - before;
  state_.support_energy += by;
  state_.ledger.input += by;
  stepper_.forget_history();
}

void Control::set_spring_stiffness(std::size_t spring, double stiffness) {
  check_spring(spring);
  if (!std::isfinite(stiffness) || stiffness < 0.0)
    refuse("stiffness", std::to_string(stiffness), "a finite number, at least 0");
  std::size_t place = 0;
  const PointSprings* springs = springs_of(model_, place);
  with_input([&] {
    if (memory_.spring_stiffness.empty()) {
      for (const dynamics::PointSpring& one : springs->springs())
        memory_.spring_stiffness.push_back(one.stiffness);
    }
    memory_.spring_stiffness[spring] = stiffness;
    model_.spring_stiffness = memory_.spring_stiffness;
  });
}

void Control::set_spring_force(std::size_t spring, double force) {
  check_spring(spring);
  const SpringNow now = springs()[spring];
  if (!now.is_there || !(now.stiffness > 0.0))
    refuse("spring", std::to_string(spring), "a spring that is there and has a stiffness");
  if (!(std::abs(force) <= now.yield))
    refuse("force", std::to_string(force), fmt::format("at most {} N/m", now.yield));
  std::size_t place = 0;
  const PointSprings* springs = springs_of(model_, place);
  with_input([&] { springs->set_force(model_, state_, spring, force, state_.couplings[place]); });
}

}  // namespace keyblock::simulation
