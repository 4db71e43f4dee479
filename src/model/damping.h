#pragma once
#include "model/integrator.h"

namespace keyblock::dynamics {

/// Share of critical by which a rule of time integration damps an oscillator that has no damping of its own: −ln |λ| / |ln λ| of the roots λ of
/// its step. frequency: Hz; step: s; both above zero. 1 where it does not
/// swing, or a step is longer than half of its period.
[[nodiscard]] double numerical_damping(const Integrator& rule, double step, double frequency);
/// The same of bodies that swing on a spring between points (Integrator::place_of_spring).
[[nodiscard]] double numerical_damping_of_spring(const Integrator& rule, double step, double frequency);

}  // namespace keyblock::dynamics
