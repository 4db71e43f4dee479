#include "simulation/checkpoint_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <span>
#include <tuple>
#include <utility>

#include "core/index.h"
#include "coupling/coupling.h"
#include "record/stage_checks.h"
#include "simulation/wall_faces.h"

namespace keyblock::simulation {
namespace {

using dynamics::Model;
using dynamics::State;

constexpr long largest_count = 1'000'000'000'000'000;

bool all_finite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

bool are_counts(std::initializer_list<long> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](long n) { return n >= 0 && n <= largest_count; });
}

bool is_place(int number, std::size_t count) {
  return number >= 0 && at(number) < count;
}

bool are_flags(std::span<const std::uint8_t> flags, std::uint8_t largest = 1) {
  return std::all_of(flags.begin(), flags.end(), [&](std::uint8_t x) { return x <= largest; });
}

// A bool that was read as bytes may be none.
bool is_bool(const bool& value) {
  std::uint8_t byte = 0;
  std::memcpy(&byte, &value, sizeof(byte));
  return byte <= 1;
}

template <class Things, class Before>
bool ascends(const Things& things, const Before& before) {
  return std::adjacent_find(things.begin(), things.end(),
                            [&](const auto& a, const auto& b) { return !before(a, b); }) == things.end();
}

bool is_candidate(const contact::Candidate& c, const contact::Surface& surface) {
  const auto vertices = at(surface.vertices());
  return is_place(c.vertex, vertices) && is_place(c.edge, vertices) &&
         c.block_a == surface.block[at(c.vertex)] && c.block_b == surface.block[at(c.edge)] &&
         c.block_a != c.block_b &&
         !(surface.fixed[at(c.block_a)] != 0 && surface.fixed[at(c.block_b)] != 0) &&
         std::isfinite(c.clearance);
}

bool comes_before(const contact::Candidate& x, const contact::Candidate& y) {
  const auto key = [](const contact::Candidate& c) {
    return std::tuple(std::min(c.block_a, c.block_b), std::max(c.block_a, c.block_b), c.vertex, c.edge);
  };
  return key(x) < key(y);
}

bool is_memory(const contact::Memory& m) {
  const double numbers[] = {m.offset,         m.stiffness, m.shear,       m.normal_force,
                            m.bounding_force, m.stored,    m.bond_length, m.worn};
  return m.state <= contact::State::locked && is_bool(m.bonded) && is_bool(m.in_face) && is_bool(m.is_torn) &&
         all_finite(numbers);
}

bool are_pieces(const contact::CandidateList& list, const contact::Surface& surface) {
  const auto is_piece = [&](const contact::JointPiece& p) {
    return is_place(p.vertex, surface.position.size()) && is_place(p.edge, surface.position.size()) &&
           std::isfinite(p.worn) && p.worn >= 0.0 && is_bool(p.is_touched);
  };
  const auto comes_first = [](const contact::JointPiece& x, const contact::JointPiece& y) {
    return std::pair(x.vertex, x.edge) < std::pair(y.vertex, y.edge);
  };
  const auto has_piece = [&](const contact::Memory& m) {
    return m.piece == -1 || is_place(m.piece, list.pieces.size());
  };
  return std::all_of(list.pieces.begin(), list.pieces.end(), is_piece) && ascends(list.pieces, comes_first) &&
         std::all_of(list.memory.begin(), list.memory.end(), has_piece);
}

bool are_contacts(const contact::CandidateList& list, const contact::Surface& surface) {
  return std::all_of(list.pairs.begin(), list.pairs.end(),
                     [&](const contact::Candidate& c) { return is_candidate(c, surface); }) &&
         ascends(list.pairs, comes_before) && ascends(list.tracked, std::less<>()) &&
         std::all_of(list.tracked.begin(), list.tracked.end(),
                     [&](int k) { return is_place(k, list.pairs.size()); }) &&
         list.memory.size() == list.tracked.size() &&
         std::all_of(list.memory.begin(), list.memory.end(), is_memory) && are_pieces(list, surface);
}

bool is_pattern(const std::vector<std::pair<int, int>>& pattern, const Model& model) {
  int moving = 0;
  for (std::size_t b = 0; b < model.bodies(); ++b) moving = std::max(moving, model.body(b).unknown + 1);
  return ascends(pattern, std::less<>()) &&
         std::all_of(pattern.begin(), pattern.end(), [&](const auto& pair) {
           return pair.first >= 0 && pair.first < pair.second && pair.second < moving;
         });
}

bool are_couplings(const State& s, const Model& model) {
  return std::equal(s.couplings.begin(), s.couplings.end(), model.couplings.begin(), model.couplings.end(),
                    [](const std::vector<double>& memory, const auto& coupling) {
                      return memory.size() == coupling->memory_size() && all_finite(memory);
                    });
}

bool are_walls(const State& s, const RunSetup& setup, const Model& model) {
  const dynamics::WallState& walls = s.walls;
  const std::size_t excavations = setup.excavations.size(), vertices = at(model.surface.vertices());
  if (walls.left.empty()) return walls.forces.empty() && !wall_loads(setup, model);
  return walls.left.size() == model.blocks.size() && are_flags(walls.left) &&
         walls.released.size() == excavations && walls.pressure.size() == excavations &&
         all_finite(walls.released) && all_finite(walls.pressure) &&
         std::all_of(walls.forces.begin(), walls.forces.end(), [&](const dynamics::WallForce& force) {
           return is_place(force.vertex, vertices) && is_place(force.excavation, excavations) &&
                  std::isfinite(force.force.x) && std::isfinite(force.force.y);
         });
}

bool are_points(std::span<const record::ReleasePoint> points, const RunSetup& setup) {
  return std::all_of(points.begin(), points.end(), [&](const record::ReleasePoint& p) {
    return is_place(p.excavation, setup.excavations.size()) && std::isfinite(p.released) &&
           are_counts({p.step});
  });
}

bool is_opening(const RunState& state, const RunSetup& setup, const Model& model) {
  const StagedOpening::Memory& memory = state.opening;
  const State& s = state.mechanics;
  if (memory.part < 0 || !are_points(memory.points, setup)) return false;
  const bool is_within_stage = state.stage_step > 0 && !s.walls.left.empty();
  if (memory.before.empty()) return memory.start.empty() && memory.points.empty() && !is_within_stage;
  if (s.walls.left.empty() || memory.before.size() != setup.excavations.size() ||
      memory.start.size() != memory.before.size() || !all_finite(memory.before))
    return false;
  for (std::size_t e = 0; e < memory.start.size(); ++e) {
    const std::size_t ends = memory.start[e].size();
    if (ends != 0 && ends != 2 * wall_faces(setup, model, e).size()) return false;
  }
  return true;
}

bool has_sizes(const State& s, const Model& model) {
  const std::size_t blocks = model.blocks.size();
  const bool keeps_accelerations = model.solver.integrator != dynamics::TimeIntegration::shi;
  const std::size_t kept = keeps_accelerations ? model.coefficients : 0;
  return s.position.size() == model.coefficients && s.velocity.size() == model.coefficients &&
         s.acceleration.size() == kept && s.force.size() == kept &&
         s.acceleration_known.size() == (keeps_accelerations ? model.bodies() : 0) &&
         s.moved.size() == blocks && are_couplings(s, model);
}

bool has_numbers(const State& s) {
  const double numbers[] = {s.time,           s.last_step,        s.ledger.friction, s.ledger.damping,
                            s.ledger.input,   s.ledger.numerical, s.ledger.radiated, s.ledger.water,
                            s.contact_energy, s.support_energy};
  return all_finite(numbers) && s.time >= 0.0 && s.last_step >= 0.0 && are_counts({s.step}) &&
         all_finite(s.position) && all_finite(s.velocity) && all_finite(s.acceleration) &&
         all_finite(s.force) && all_finite(s.moved) && are_flags(s.acceleration_known);
}

bool is_diameter(const Diameter& d, std::size_t blocks) {
  return std::all_of(std::begin(d.blocks), std::end(d.blocks),
                     [&](int b) { return b == -1 || is_place(b, blocks); });
}

bool is_damage(const DamageGauge::Memory& memory, const RunSetup& setup, const Model& model) {
  const std::size_t blocks = model.blocks.size(), vertices = at(model.surface.vertices());
  const DamageGauge::Reference& r = memory.reference;
  const bool pieces =
      std::all_of(memory.pieces.begin(), memory.pieces.end(), [&](const JointGauge::Piece& p) {
        return is_place(p.vertex, vertices) && is_place(p.edge, vertices) && std::isfinite(p.along) &&
               std::isfinite(p.length);
      });
  return r.open.size() == setup.excavations.size() && are_flags(r.open) &&
         (r.start.empty() || r.start.size() == blocks) && r.turn.size() == r.start.size() &&
         r.base.size() == r.start.size() && (r.of_stage.empty() || r.of_stage.size() == blocks) &&
         is_diameter(r.height, blocks) && is_diameter(r.width, blocks) && pieces &&
         ascends(memory.pieces, [](const JointGauge::Piece& a, const JointGauge::Piece& b) {
           return std::pair(a.vertex, a.edge) < std::pair(b.vertex, b.edge);
         });
}

bool is_settler(const Settler::Memory& s, std::size_t blocks) {
  const MovingBlocks::Memory& m = s.blocks;
  const bool sizes = s.inertia_scale.size() == blocks && m.travel_limit.size() == blocks &&
                     m.travel.size() == blocks && m.nearest.size() == blocks && m.carried.size() == blocks &&
                     m.astray.size() == blocks && m.state.size() == blocks;
  constexpr std::uint8_t last_state = 2;
  return sizes && std::isfinite(s.time_step) && s.time_step > 0.0 && std::isfinite(s.creep) &&
         s.creep > 0.0 && are_counts({s.steps, s.quiet_steps, s.since_best, s.wait, m.candidates}) &&
         at(m.candidates) <= blocks && are_flags(m.state, last_state) && all_finite(s.inertia_scale) &&
         all_finite(m.travel_limit) && all_finite(m.travel) && all_finite(m.carried) &&
         all_finite(m.astray) &&
         std::all_of(s.inertia_scale.begin(), s.inertia_scale.end(), [](double x) { return x >= 1.0; });
}

bool is_record(const record::StageRecord& record, const record::Stage& stage, const RunSetup& setup,
               std::size_t blocks) {
  const record::Stage& s = record.stage;
  return s.name == stage.name && s.kind == stage.kind && s.excavate == stage.excavate &&
         s.install == stage.install && s.motion == stage.motion && are_counts({record.steps}) &&
         record::has_known_blocks(record, blocks) && are_points(record.release, setup) &&
         record.motion_time.size() == record.motion.size();
}

bool is_still(const Stillness::Memory& still, const Model& model) {
  return std::isfinite(still.since) &&
         (still.places.empty() || still.places.size() == model.surface.position.size());
}

bool are_breaks(const std::vector<record::BreakCount>& breaks, const RunSetup& setup, const Model& model) {
  const auto is_stage = [&](int stage) { return is_place(stage, setup.stages.size()); };
  return std::all_of(breaks.begin(), breaks.end(), [&](const record::BreakCount& b) {
    return b.kind <= cutting::EdgeKind::domain && b.mode <= last_of(record::BreakMode()) && b.events > 0 &&
           (b.element == -1 || is_place(b.element, element_count(model))) && is_stage(b.first_stage) &&
           is_stage(b.last_stage) && all_finite(std::array{b.length, b.first, b.last});
  });
}

bool has_counts(const RunState& state) {
  const record::OpenCloseStatistics& s = state.record.open_close;
  const record::Reported& r = state.reported;
  return are_counts({state.stage_step, state.iterations, s.max_iterations, s.retried_steps,
                     s.unconverged_steps, s.last_converged_step, state.record.contact_checks.across_gaps,
                     r.frames, r.contacts, r.histories, r.breaks, r.steps, r.stages}) &&
         state.stage_step <= state.mechanics.step && s.last_converged_step <= state.mechanics.step &&
         r.stages == state.stage && std::isfinite(state.stage_start) && std::isfinite(state.initial_energy) &&
         std::isfinite(state.wall_time);
}

bool is_at_a_stage(const RunState& state, const RunSetup& setup) {
  return state.stage >= 0 && at(state.stage) <= setup.stages.size() &&
         state.record.stages.size() == at(state.stage) &&
         (at(state.stage) < setup.stages.size() || state.stage_step == 0);
}

bool are_records(const RunState& state, const RunSetup& setup, std::size_t blocks) {
  for (std::size_t k = 0; k < state.record.stages.size(); ++k) {
    if (!is_record(state.record.stages[k], setup.stages[k], setup, blocks)) return false;
  }
  return true;
}

/// Places where blocks overlap, or press across a gap.
bool are_overlaps(const record::RunRecord& record, std::size_t blocks) {
  const record::ContactChecks& vertices = record.contact_checks;
  const auto is_known = [&](int b) { return b == -1 || is_place(b, blocks); };
  return std::ranges::all_of(
      std::array{&record.max_overlap, &vertices.farthest, &vertices.deepest, &vertices.unexplained},
      [&](const record::OverlapRecord* o) { return is_known(o->block_a) && is_known(o->block_b); });
}

/// Largest forces of all elements, or of none before the first step.
bool are_peaks(const std::vector<ElementPeak>& peaks, const RunSetup& setup, const Model& model) {
  return (peaks.empty() || peaks.size() == element_count(model)) &&
         std::ranges::all_of(peaks, [&](const ElementPeak& p) {
           return std::isfinite(p.force) && p.force >= 0.0 && std::isfinite(p.time) && p.utilization >= 0.0 &&
                  (p.stage == -1 || is_place(static_cast<int>(p.stage), setup.stages.size()));
         });
}

/// Of each support that a stage installs, whether it is there.
bool are_supports(std::span<const std::uint8_t> installed, const RunSetup& setup) {
  return installed.size() == setup.staged_supports.size() && are_flags(installed);
}

}  // namespace

std::string mistake_in_orders(const OrderControl::Memory& memory, const RunSetup& setup, const Model& model) {
  const std::size_t blocks = model.blocks.size();
  const auto is_order = [&](std::size_t b) {
    const int order = memory.orders[b];
    const bool is_free = b < setup.properties.size() && setup.properties[b].automatic_order;
    return order == model.blocks[b].basis.order() ||
           (is_free && order >= 1 && order <= setup.automatic_order.highest_order);
  };
  const auto fits = [&](std::size_t size) { return size == 0 || size == blocks; };
  bool known = fits(memory.orders.size()) && fits(memory.lowered.size()) && are_flags(memory.lowered);
  for (std::size_t b = 0; known && b < memory.orders.size(); ++b) known = is_order(b);
  return known ? "" : "orders of blocks that cannot be";
}

std::string mistake_in_state(const RunState& state, const RunSetup& setup, const Model& model) {
  const std::size_t blocks = model.blocks.size();
  if (!is_at_a_stage(state, setup)) return "another number of stages";
  if (!has_counts(state)) return "counts of steps that cannot be";
  if (!has_sizes(state.mechanics, model) || state.present.size() != blocks || !are_flags(state.present))
    return "a state of other blocks";
  if (!has_numbers(state.mechanics)) return "positions or velocities that are no finite numbers";
  if (!are_contacts(state.mechanics.contacts, model.surface) || !is_pattern(state.mechanics.pattern, model))
    return "contacts that cannot be";
  if (!are_walls(state.mechanics, setup, model) || !is_opening(state, setup, model))
    return "loads on walls that cannot be";
  if (!are_supports(state.mechanics.installed, setup)) return "supports that are not of this run";
  if (!are_peaks(state.peaks, setup, model)) return "forces of elements that are not of this run";
  if (!are_breaks(state.record.breaks, setup, model)) return "breaks that are not of this run";
  if (!is_damage(state.damage, setup, model)) return "measures of damage that cannot be";
  const bool settles =
      state.stage_step > 0 && setup.stages[at(state.stage)].kind == record::StageKind::settle;
  if (settles && !is_settler(state.settler, blocks)) return "a settling stage that cannot be";
  if (!is_still(state.still, model)) return "places of other vertices";
  if (const std::string mistake = mistake_in_control(state.control, model); !mistake.empty()) return mistake;
  if (!are_records(state, setup, blocks)) return "stages that are not of this run";
  return are_overlaps(state.record, blocks) ? "" : "an overlap of unknown blocks";
}

}  // namespace keyblock::simulation
