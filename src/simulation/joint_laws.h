#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "contact/joint_law.h"
#include "cutting/block_system.h"
#include "simulation/control.h"
#include "simulation/setup.h"

/// Which law a joint has. Their numbers: 0 `joints`, 1 the frame, 2 outlines of excavations before they are opened, then joint sets with rock bridges and
/// interfaces, then trace maps, then traces that have strengths of their own (JointTable::of_traces).
namespace keyblock::simulation {

/// Number of the law of the first joint set; those of the others follow, then those of trace maps.
inline constexpr int first_set_law = 3;

/// Number of the law of a joint set or an interface.
int law_of_set(cutting::EdgeLabel label);
/// Number of the law of an edge (Surface::joint).
int joint_law(const RunSetup& setup, cutting::EdgeLabel label);
/// Numbers of the laws of a joint set, an interface, a trace map, `joints` or `frame`: that of the whole first, then those of its traces. Empty: there
/// is no such name.
std::vector<std::size_t> find_laws(const RunSetup& setup, std::string_view name);
/// Which set (from 0 on, then maps) a law is of; none: of no set or map.
std::optional<std::size_t> set_of_law(const RunSetup& setup, std::size_t law);

/// All laws, as the setup has them.
std::vector<contact::JointLaw> joint_laws(const RunSetup& setup);
/// With what a program that steers the run has changed.
std::vector<contact::JointLaw> given_laws(const RunSetup& setup, const ControlMemory& memory);
/// As they act in a stage: divided by its factor.
std::vector<contact::JointLaw> laws_in_stage(const RunSetup& setup, const ControlMemory& memory,
                                             const record::Stage& stage);

/// Gives a law another strength at the peak; what is left at the end is no more.
void put_strength(const Strength& strength, contact::JointLaw& law);

}  // namespace keyblock::simulation
