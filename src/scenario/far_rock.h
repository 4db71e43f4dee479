#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// Rock with its joint sets, as long waves that go up and down feel it. Of a set, d is the distance of its traces in the section, n the
/// normal of these, and p = length / (length + gap) the share of each plane that is joint. Stress and strain in the order xx, yy, xy, with
/// the engineering shear strain:
///
///     S = S₀ + Σ p/d (N Nᵀ/k_n + T Tᵀ/k_s),     N = (n_x², n_y², 2 n_x n_y),   T = (−n_x n_y, n_x n_y, n_x² − n_y²)
///
/// S₀: compliance of the rock in the section. Moduli are those of S⁻¹, where nothing moves sideways. Trace maps do not count.
dynamics::RockLayer effective_rock(const Scenario& scenario, const simulation::JointTable& joints);

/// What [boundary] is for a run; heights less `origin`, m. Nothing without [boundary], or with a frame.
std::optional<simulation::Boundary> boundary_of(const Scenario& scenario,
                                                const simulation::JointTable& joints, double origin);

/// The motions as a compliant base takes them, those of an outcrop: twice the wave that goes up.
void take_to_outcrop(const Scenario& scenario, std::vector<loading::GroundMotion>& motions);

/// What is said of the rock around the model in reports. origin: m, that heights are local to.
std::vector<std::pair<std::string, std::string>> boundary_facts(const simulation::Boundary& boundary,
                                                                double origin);

/// What seems wrong with [boundary] and what acts on it.
void add_boundary_warnings(const Scenario& scenario, const simulation::RunSetup& setup,
                           std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
