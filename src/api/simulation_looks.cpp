#include <cmath>

#include "api/contact_columns.h"
#include "api/simulation_parts.h"
#include "record/damage_fields.h"
#include "simulation/checkpoint.h"

// What a simulation is like.
namespace keyblock {

double Simulation::time() const {
  return parts_->runner().state().time;
}

long Simulation::step() const {
  return parts_->runner().state().step;
}

int Simulation::stage() const {
  return parts_->runner().stage();
}

std::vector<std::string> Simulation::stages() const {
  std::vector<std::string> names;
  for (const std::string& name : parts_->listener.model.stage_names) names.push_back(name);
  return names;
}

std::vector<std::string> Simulation::warnings() const {
  return parts_->warnings;
}

std::string Simulation::state_hash() const {
  return simulation::state_hash(parts_->runner().state());
}

std::size_t Simulation::blocks() const {
  return parts_->runner().model().blocks.size();
}

std::span<const double> Simulation::vertices() const {
  static_assert(sizeof(Vec2) == 2 * sizeof(double));
  const std::vector<Vec2>& points = parts_->runner().model().surface.position;
  return {points.empty() ? nullptr : &points.front().x, 2 * points.size()};
}

std::span<const int> Simulation::first_vertex() const {
  return parts_->runner().model().surface.block_begin;
}

std::span<const std::uint8_t> Simulation::present() const {
  return parts_->runner().model().surface.present;
}

std::vector<double> Simulation::centroids() const {
  const dynamics::Model& model = parts_->runner().model();
  const std::vector<double>& a = parts_->runner().state().position;
  std::vector<double> centroids;
  for (const dynamics::Block& block : model.blocks) {
    const double scale = 1.0 / std::sqrt(block.area);
    centroids.push_back(a[block.first] * scale);
    centroids.push_back(a[block.first + 1] * scale);
  }
  return centroids;
}

std::vector<double> Simulation::block_velocities() const {
  const std::vector<double>& v = parts_->runner().state().velocity;
  std::vector<double> velocities;
  for (const dynamics::Block& block : parts_->runner().model().blocks) {
    const double scale = 1.0 / std::sqrt(block.area);
    velocities.push_back(v[block.first] * scale);
    velocities.push_back(v[block.first + 1] * scale);
  }
  return velocities;
}

std::span<const double> Simulation::velocity() const {
  return parts_->runner().state().velocity;
}

std::vector<std::size_t> Simulation::first_coefficient() const {
  std::vector<std::size_t> first;
  for (const dynamics::Block& block : parts_->runner().model().blocks) first.push_back(block.first);
  return first;
}

std::vector<BlockFacts> Simulation::block_facts() const {
  const record::ModelRecord& model = parts_->listener.model;
  std::vector<BlockFacts> facts;
  for (const record::ModelRecord::Block& block : model.blocks) {
    BlockFacts& of = facts.emplace_back(
        BlockFacts{block.name, {}, block.fixed, block.area, block.density, block.young, block.poisson});
    for (const int e : block.excavations)
      of.excavations.push_back(model.excavation_names.at(static_cast<std::size_t>(e)));
  }
  return facts;
}

std::array<double, 2> Simulation::origin() const {
  const Vec2 origin = parts_->listener.model.origin;
  return {origin.x, origin.y};
}

std::vector<double> Simulation::stress() const {
  const std::vector<double>& a = parts_->runner().state().position;
  std::vector<double> stress;
  for (const dynamics::Block& block : parts_->runner().model().blocks) {
    const block::Stress s = block.fixed ? block::Stress{} : block.elasticity.mean_cauchy(&a[block.first]);
    stress.insert(stress.end(), {s.xx, s.yy, s.xy});
  }
  return stress;
}

std::vector<std::uint8_t> Simulation::status() const {
  std::vector<std::uint8_t> status;
  for (const record::BlockStatus s : parts_->runner().status())
    status.push_back(static_cast<std::uint8_t>(s));
  return status;
}

std::vector<std::pair<std::string, double>> Simulation::damage() const {
  std::vector<std::pair<std::string, double>> measures;
  if (const auto damage = parts_->runner().damage()) {
    for (const std::string& name : record::damage_names())
      measures.emplace_back(name, record::damage_value(*damage, name));
  }
  return measures;
}

std::array<double, 2> Simulation::ground_acceleration() const {
  const Vec2 a = parts_->runner().ground_acceleration();
  return {a.x, a.y};
}

std::vector<SpringState> Simulation::springs() const {
  std::vector<SpringState> springs;
  for (const simulation::SpringNow& s : parts_->runner().control().springs())
    springs.push_back({s.name,
                       {s.from.x, s.from.y},
                       {s.to.x, s.to.y},
                       s.length,
                       s.stiffness,
                       s.force,
                       s.yield,
                       s.is_there});
  return springs;
}

std::vector<AppliedForce> Simulation::forces() const {
  std::vector<AppliedForce> forces;
  for (const simulation::AppliedForce& f : parts_->runner().control().forces())
    forces.push_back({static_cast<std::size_t>(f.block), f.slot, {f.force.x, f.force.y}});
  return forces;
}

std::size_t Simulation::contact_count() const {
  const simulation::Runner& runner = parts_->runner();
  return runner.state().step == 0 ? 0 : runner.contact_count();
}

Contacts Simulation::contacts() const {
  return contacts(api::all_contact_columns());
}

Contacts Simulation::contacts(const std::vector<ContactColumn>& columns) const {
  api::ContactColumns made(parts_->listener.model, contact_count(), columns);
  if (contact_count() > 0)
    parts_->runner().each_contact([&](std::span<const record::ContactRecord> some) { made.add(some); },
                                  made.parts());
  return made.take();
}

std::vector<ContactStrength> Simulation::contact_strengths() const {
  const auto given = [](double value) {
    return contact::ContactStrength::is_given(value) ? std::optional(value) : std::nullopt;
  };
  std::vector<ContactStrength> strengths;
  for (const contact::ContactStrength& s : parts_->runner().control().contact_strengths())
    strengths.push_back({s.vertex, s.edge, given(api::degrees_of(s.friction_coefficient)), given(s.cohesion),
                         given(s.tension)});
  return strengths;
}

std::vector<std::pair<std::string, double>> Simulation::energy() const {
  const record::Energy e = parts_->runner().energy();
  return {{"kinetic", e.kinetic}, {"strain", e.strain},       {"gravity", e.gravity},
          {"contact", e.contact}, {"friction", e.friction},   {"damping", e.damping},
          {"input", e.input},     {"numerical", e.numerical}, {"radiated", e.radiated},
          {"water", e.water}};
}

}  // namespace keyblock
