#pragma once
#include <vector>

#include "record/joint_records.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Joints of every set, then of every trace map; a row for each trace that bounds blocks where traces have strengths of their own.
std::vector<record::JointRecord> joint_records(const RunSetup& setup);

}  // namespace keyblock::simulation
