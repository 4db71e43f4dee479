#include "keyblock/simulation.h"

#include <atomic>
#include <cmath>
#include <exception>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "api/contact_columns.h"
#include "api/scenario_source.h"
#include "api/steered.h"
#include "core/error.h"
#include "core/out_of_memory.h"
#include "job/recorded_run.h"
#include "keyblock/keyblock.h"
#include "results/summary.h"
#include "scenario/build.h"
#include "simulation/checkpoint.h"
#include "simulation/damage_fields.h"
#include "simulation/feasibility.h"
#include "simulation/refuse.h"

namespace keyblock {
namespace {

using simulation::refuse;

constexpr double degrees = 180.0 / std::numbers::pi;

job::ResultFolder::Use use_of(const RunOptions& options) {
  if (options.resume) return job::ResultFolder::Use::resume;
  return options.replace ? job::ResultFolder::Use::replace : job::ResultFolder::Use::fresh;
}

void check(const RunOptions& options) {
  if (options.threads < 1 || options.threads > 1024)
    refuse("threads", std::to_string(options.threads), "a whole number from 1 to 1024");
  if (options.realization < 0)
    refuse("realization", std::to_string(options.realization), "a whole number, at least 0");
  if (options.resume && options.replace) refuse("resume", "resume and replace together", "one of them");
  if (options.resume && options.folder.empty()) refuse("resume", "no folder", "the folder of the run");
}

}  // namespace

struct Simulation::Parts {
  Parts() = default;
  /// Passes progress on and keeps what summary.json is made of.
  class Listener final : public simulation::RunObserver {
   public:
    void begin(const simulation::ModelRecord& record) override { model = record; }
    void progress(const simulation::Progress& now) override {
      if (!call) return;
      call({now.stage, now.stage_count, now.stage_name, now.fraction, now.time, now.step, now.seconds_left});
    }

    simulation::ModelRecord model;
    std::function<void(const Progress&)> call;
  };

  Parts(const Scenario& of, const RunOptions& options);

  [[nodiscard]] simulation::Runner& runner() {
    if (recorded) return recorded->runner();
    if (alone) return *alone;
    if (borrowed == nullptr) throw std::logic_error("the run has ended");
    return *borrowed;
  }
  simulation::RunOptions run_options(const RunOptions& options);
  /// An exception of a caller's function stops the run, which ends in good order; advance() throws it then.
  template <typename Call>
  void keep_failure(const Call& call) {
    try {
      call();
    } catch (...) {
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  }

  /// While it lives, a step is taken: what would begin another one is refused.
  class Stepping {
   public:
    explicit Stepping(Parts& of) : of_(of) {
      if (of_.stepping) throw std::logic_error("the simulation is within a step");
      of_.stepping = true;
    }
    ~Stepping() { of_.stepping = false; }
    Stepping(const Stepping&) = delete;
    Stepping& operator=(const Stepping&) = delete;

   private:
    Parts& of_;
  };

  bool stepping = false;
  bool closed = false;  ///< it goes on no more
  scenario::Scenario scenario;
  std::vector<std::string> warnings;
  simulation::RunSetup setup;
  Listener listener;
  std::atomic<bool> stop = false;
  std::function<void()> after_step;
  std::function<void(const Progress&)> progress;
  std::exception_ptr failure;
  std::optional<job::RecordedRun> recorded;  ///< of a run with a folder
  std::optional<simulation::Runner> alone;   ///< of a run without one
  simulation::Runner* borrowed = nullptr;    ///< of a run that somebody else steps
  std::string summary;                       ///< once it is finished
};

simulation::RunOptions Simulation::Parts::run_options(const RunOptions& options) {
  simulation::RunOptions run;
  run.threads = options.threads;
  run.stop = &stop;
  run.after_step = [this](simulation::Runner&, const dynamics::StepReport&) {
    if (after_step) keep_failure(after_step);
  };
  return run;
}

Simulation::Parts::Parts(const Scenario& of, const RunOptions& options) : scenario(api::parsed(of)) {
  check(options);
  setup = scenario::build_setup(scenario, options.realization, &warnings);
  setup.version = version();
  setup.hooks = options.hooks;
  listener.call = [this](const Progress& now) {
    if (progress) keep_failure([&] { progress(now); });
  };
  if (options.folder.empty()) {
    with_memory_for([&] { return simulation::memory_purpose(setup); },
                    [&] { alone.emplace(setup, run_options(options), listener); });
    return;
  }
  recorded.emplace(scenario, setup,
                   job::RecordedRun::Options{options.folder, use_of(options), run_options(options)},
                   listener);
  if (recorded->has_ended())
    refuse("resume", "a run that has ended", "a run that was stopped; its results are in the folder");
  recorded->start();
}

Simulation::Simulation(const Scenario& scenario, const RunOptions& options)
    : parts_(std::make_unique<Parts>(scenario, options)) {}
Simulation::Simulation(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

namespace api {

struct SimulationAccess {
  static std::shared_ptr<Simulation> make(const simulation::ModelRecord& model) {
    auto parts = std::make_unique<Simulation::Parts>();
    parts->stepping = true;  // by somebody else, all the time
    parts->listener.model = model;
    parts->warnings = model.warnings;
    return std::shared_ptr<Simulation>(new Simulation(std::move(parts)));
  }
  static void put(Simulation& simulation, simulation::Runner* runner) {
    simulation.parts_->borrowed = runner;
  }
  static bool was_stopped(const Simulation& simulation) { return simulation.parts_->stop; }
};

namespace {

class ModelKeeper final : public simulation::RunObserver {
 public:
  explicit ModelKeeper(simulation::ModelRecord& model) : model_(model) {}
  void begin(const simulation::ModelRecord& model) override { model_ = model; }

 private:
  simulation::ModelRecord& model_;
};

}  // namespace

Steered::~Steered() {
  if (simulation_) SimulationAccess::put(*simulation_, nullptr);
}

std::unique_ptr<simulation::RunObserver> Steered::observer() {
  return std::make_unique<ModelKeeper>(model_);
}

Simulation& Steered::of(simulation::Runner& runner) {
  if (!simulation_) simulation_ = SimulationAccess::make(model_);
  SimulationAccess::put(*simulation_, &runner);
  return *simulation_;
}

bool Steered::was_stopped() const {
  return simulation_ && SimulationAccess::was_stopped(*simulation_);
}

}  // namespace api

bool Simulation::advance() {
  const Parts::Stepping now(*parts_);
  if (parts_->runner().done()) return false;
  if (parts_->closed) throw std::logic_error("the simulation was closed");
  if (parts_->recorded) {
    parts_->recorded->advance();
  } else {
    parts_->alone->advance();
  }
  if (parts_->failure) std::rethrow_exception(std::exchange(parts_->failure, nullptr));
  return !parts_->runner().done();
}

bool Simulation::done() const {
  return parts_->runner().done();
}

std::string Simulation::finish() {
  if (!parts_->summary.empty()) return parts_->summary;
  const Parts::Stepping now(*parts_);
  if (parts_->closed) throw std::logic_error("the simulation was closed");
  parts_->closed = true;
  const simulation::RunRecord record =
      parts_->recorded ? parts_->recorded->finish() : parts_->alone->finish();
  return parts_->summary = results::summary_json(parts_->listener.model, record);
}

void Simulation::close() {
  const Parts::Stepping now(*parts_);
  parts_->closed = true;
  if (parts_->recorded) parts_->recorded->close();
}

void Simulation::stop() noexcept {
  parts_->stop = true;
}

void Simulation::after_step(std::function<void()> call) {
  parts_->after_step = std::move(call);
}

void Simulation::on_progress(std::function<void(const Progress&)> call) {
  parts_->progress = std::move(call);
}

// ── what it is like ──────────────────────────────────────────────────────────────────────────────────────────────────

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
  const simulation::ModelRecord& model = parts_->listener.model;
  std::vector<BlockFacts> facts;
  for (const simulation::ModelRecord::Block& block : model.blocks) {
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
  for (const simulation::BlockStatus s : parts_->runner().status())
    status.push_back(static_cast<std::uint8_t>(s));
  return status;
}

std::vector<std::pair<std::string, double>> Simulation::damage() const {
  std::vector<std::pair<std::string, double>> measures;
  if (const auto damage = parts_->runner().damage()) {
    for (const std::string& name : simulation::damage_names())
      measures.emplace_back(name, simulation::damage_value(*damage, name));
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

Contacts Simulation::contacts() const {
  if (parts_->runner().state().step == 0) return {};
  return api::contact_columns(parts_->runner().contacts(), parts_->listener.model);
}

std::vector<std::pair<std::string, double>> Simulation::energy() const {
  const simulation::Energy e = parts_->runner().energy();
  return {{"kinetic", e.kinetic}, {"strain", e.strain},       {"gravity", e.gravity},
          {"contact", e.contact}, {"friction", e.friction},   {"damping", e.damping},
          {"input", e.input},     {"numerical", e.numerical}, {"radiated", e.radiated}};
}

// ── changes ──────────────────────────────────────────────────────────────────────────────────────────────────────────

void Simulation::set_velocity(std::span<const double> velocity) {
  parts_->runner().control().set_velocity(velocity);
}

JointStrength Simulation::strength(const std::string& joint) const {
  const contact::JointLaw* law = parts_->runner().control().law(joint);
  if (law == nullptr)
    refuse("joint", "\"" + joint + "\"",
           "the name of a joint set or of a trace map, \"joints\" or \"frame\"");
  return {std::atan(law->friction_coefficient) * degrees, law->cohesion, law->tension};
}

void Simulation::set_strength(const std::string& joint, const JointStrength& strength) {
  if (!(strength.friction >= 0.0 && strength.friction < 90.0))
    refuse("friction", std::to_string(strength.friction), "degrees, from 0 to less than 90");
  // What was read and is set again changes no bit.
  const bool same = strength.friction == this->strength(joint).friction;
  const double coefficient = same ? parts_->runner().control().law(joint)->friction_coefficient
                                  : std::tan(strength.friction / degrees);
  parts_->runner().control().set_strength(joint, {coefficient, strength.cohesion, strength.tension});
}

void Simulation::set_load_factor(std::size_t load, double factor) {
  parts_->runner().control().set_load_scale(load, factor);
}

void Simulation::set_force(std::size_t block, const std::array<double, 2>& force,
                           const std::optional<std::array<double, 2>>& place, std::int64_t slot) {
  const auto at = place ? std::optional(Vec2{(*place)[0], (*place)[1]}) : std::nullopt;
  parts_->runner().control().set_force(block, slot, at, {force[0], force[1]});
}

void Simulation::set_spring_stiffness(std::size_t spring, double stiffness) {
  parts_->runner().control().set_spring_stiffness(spring, stiffness);
}

void Simulation::set_spring_force(std::size_t spring, double force) {
  parts_->runner().control().set_spring_force(spring, force);
}

void Simulation::set_motion_scale(double factor) {
  parts_->runner().control().set_motion_scale(factor);
}

std::string run(const Scenario& scenario, const RunOptions& options,
                const std::function<bool(const Progress&)>& progress) {
  Simulation simulation(scenario, options);
  if (progress) {
    simulation.on_progress([&](const Progress& now) {
      if (!progress(now)) simulation.stop();
    });
  }
  while (simulation.advance()) {
  }
  return simulation.finish();
}

const char* version() {
  return KEYBLOCK_VERSION;
}

}  // namespace keyblock
