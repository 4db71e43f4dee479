#pragma once
#include "keyblock/scenario.h"
#include "scenario/scenario.h"

namespace keyblock::api {

/// Read and checked. Throws InputError.
scenario::Scenario parsed(const Scenario& scenario);

}  // namespace keyblock::api
