#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/table_reader.h"

/// The sections of a scenario: for every table of the file a function that names its keys, once, for reading and for
/// the reference alike.
namespace keyblock::scenario {

/// `per` of a strength that is drawn.
inline constexpr Word<rockmass::DrawnPer> drawn_per_words[] = {
    {"joint", rockmass::DrawnPer::joint},
    {"line", rockmass::DrawnPer::line},
    {"realization", rockmass::DrawnPer::realization}};

/// A rule of a key that has a place under a condition alone.
inline Rule only(bool applies, std::string_view condition, Rule rule) {
  rule.applies = applies;
  rule.condition = condition;
  return rule;
}

/// All sections in an order in which names are known before they are referred to, then what concerns several.
void read_scenario(TableReader& root, Scenario& scenario);

/// The stretch of rock: [section], [domain], [rock], what read_joints() reads, [cutting], [[region]].
void read_rock_mass(TableReader& root, Scenario& scenario);
/// [joints], [[joint_set]], [[trace_map]].
void read_joints(TableReader& root, Scenario& scenario);
/// Strength and stiffness of joints of their own, which have those of [joints] else.
void read_joint_keys_of(TableReader& t, JointKeys& joints, const JointKeys& standard);
/// [[interface]], after [[block]] and all other joints.
void read_interfaces(TableReader& root, Scenario& scenario);
/// What is built into it: [[excavation]], [[block]].
void read_shapes(TableReader& root, Scenario& scenario);
/// [[block_map]], after [[block]].
void read_block_maps(TableReader& root, Scenario& scenario);
/// What is chosen of a file of lines, and how it is placed.
void read_map_choice(TableReader& t, rockmass::MapChoice& choice, bool applies, std::string_view condition);
/// `pattern` of a trace map, and what goes with it; nothing where it is not there or wrong.
void read_tessellation(TableReader& t, std::optional<rockmass::Tessellation>& read);
/// The outline of an excavation from a file that exists.
void read_drawn_outline(TableReader& t, ExcavationSpec& spec, const rockmass::MapChoice& choice,
                        const std::filesystem::path& file, Scenario& scenario);
/// [boundary], after [domain], [rock] and what is built into them.
void read_boundary(TableReader& root, Scenario& scenario);
/// [in_situ], [[motion]], [[load]], [[support]], [[spring]].
void read_loading(TableReader& root, Scenario& scenario);
/// `present` of a support, after its name: whether the run has it.
void read_present(TableReader& t, const std::string& name, Scenario& scenario);
/// [[bolt]], and the names of springs and bolts for stages that install them.
void read_bolts(TableReader& root, Scenario& scenario);
/// [[liner]], likewise.
void read_liners(TableReader& root, Scenario& scenario);
/// [water], after all joints.
void read_water(TableReader& root, Scenario& scenario);
/// `water` of a stage.
void read_water_of_stage(TableReader& t, record::Stage& stage, const Scenario& scenario);
/// One [[motion]].
void read_motion(TableReader& t, MotionSpec& motion);
/// [[suite]], after all [[motion]]: its records become motions.
void read_suites(TableReader& root, Scenario& scenario);
/// Takes out the records of suites that no stage uses: a run has no need of them, a study has.
void keep_used_records(Scenario& scenario);
/// [[study.shaking]], after the stages.
void read_shaking(TableReader& t, StudySpec& study, const Scenario& scenario);
/// [time], [[stage]], [[history]], [damage], [output], and what read_solver() reads.
void read_run(TableReader& root, Scenario& scenario);
/// [auto_order], [solver].
void read_solver(TableReader& root, Scenario& scenario);
/// `damping` of [solver], after rock_damping and contact_damping. without_ground: there is no ground far away for damping in proportion to
/// mass to be relative to.
void read_damping(TableReader& solver_keys, dynamics::SolverOptions& solver, bool without_ground);
/// [safety], after the stages.
void read_safety(TableReader& root, Scenario& scenario);
/// Names of joints, for `strength_of` of a stage and `sets` of [safety].
void read_joint_names(TableReader& t, std::string_view key, std::vector<std::string>& names,
                      const Rule& rule);
/// What [safety] makes of the stages, once all is read.
void add_trial_stage(Scenario& scenario);
/// [study], after all that its keys name.
void read_study(TableReader& root, Scenario& scenario);

/// `release` and `release_steps` of a stage whose `excavate` is known. settles: they are of its kind.
void read_release(TableReader& t, record::Stage& stage, bool settles, const Scenario& scenario);
/// `pressure` and `arc` of an excavation.
void read_pressure(TableReader& t, ExcavationSpec& spec);
/// After all stages: whether pressures are of these.
void check_pressures(TableReader& root, const Scenario& scenario);
/// Of an excavation, by index of the stages.
simulation::SupportPressure pressure_of(const Scenario& scenario, const ExcavationSpec& spec);

/// Keys of [rock]; with `required`, those without a default must be there.
void read_rock_keys(TableReader& t, RockKeys& rock, bool required);
/// `outer` and, with `holes`, `holes`: turned the right way round and checked.
void read_polygon(TableReader& t, Polygon& polygon, bool holes, const Rule& outer_rule);

/// Counter-clockwise: the air above a slope, down to its toe.
Ring slope_outline(const SlopeShape& slope);
/// Circles and horseshoes as chords, counter-clockwise.
Ring excavation_outline(const ExcavationSpec& spec);

}  // namespace keyblock::scenario
