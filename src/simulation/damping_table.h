#pragma once
#include <vector>

#include "record/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// What swings alone, and what goes as a wave, loses at 1, 3, 10 and 30 Hz; empty without dynamic stages. rock_damping is that of a block of mean area;
/// contact_damping, which differs from contact to contact, does not count.
std::vector<record::DampingRow> damping_table(const RunSetup& setup);

}  // namespace keyblock::simulation
