#pragma once
#include <span>
#include <utility>

#include "loading/motion_file.h"

namespace keyblock::loading {

/// s of the record: from 5 s before 0.1 % to 5 s after 99.9 % of Σ ∫ a² dt of all components, within what they have.
std::pair<double, double> significant_window(std::span<const MotionComponent* const> components);

}  // namespace keyblock::loading
