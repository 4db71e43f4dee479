#pragma once
#include <string>

#include "model/model.h"
#include "simulation/checkpoint.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// What of a checkpoint does not fit the run, in words; empty: nothing. Its hash tells damage, but anybody can write one with the right
/// hash. What passes both checks is a state that a run can go on from: places are there, lists are as long as what they are of and in
/// their order, numbers are finite, counts are none below zero.

/// Before the orders of blocks are taken over.
std::string mistake_in_orders(const OrderControl::Memory& orders, const RunSetup& setup,
                              const dynamics::Model& model);
/// `model` has the orders of the checkpoint.
std::string mistake_in_state(const RunState& state, const RunSetup& setup, const dynamics::Model& model);

}  // namespace keyblock::simulation
