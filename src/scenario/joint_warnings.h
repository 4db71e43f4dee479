#pragma once
#include <string>
#include <vector>

#include "scenario/build.h"

namespace keyblock::scenario {

/// What of the joints bounds blocks: "J1 62 %, faults 100 %", the share of the length of each set and map inside the domain. The rest ends in
/// rock or bounds no block. It is not in the model: blocks do not break there. Empty without such joints.
std::string joints_in_model(const Scenario& scenario, const cutting::BlockSystem& system);

/// Maps of which more than 5 % is lost, with the traces that end just short of another one, and sets of which more than 30 % is; maps that lie
/// outside the domain, with what brings them into it; blocks as large as an opening. Added to `warnings`.
void add_joint_warnings(const Scenario& scenario, const BlockModel& model,
                        std::vector<std::string>& warnings);
/// Of interfaces between blocks that do not touch, and of rock bridges that no joint has.
void add_own_joint_warnings(const Scenario& scenario, const BlockModel& model,
                            std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
