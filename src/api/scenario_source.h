#pragma once
#include <string>
#include <vector>

#include "keyblock/scenario.h"
#include "scenario/scenario.h"
#include "scenario/value.h"

namespace keyblock::api {

/// What was set, put into what the text says. Throws InputError.
scenario::Value document_of(const Scenario& scenario);
/// Read and checked. Throws InputError.
scenario::Scenario parsed(const Scenario& scenario);

}  // namespace keyblock::api
