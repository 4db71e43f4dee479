#pragma once
#include "keyblock/simulation.h"
#include "simulation/record.h"

namespace keyblock::api {

/// Rows as columns.
Contacts contact_columns(const simulation::ContactFrame& frame, const simulation::ModelRecord& model);

}  // namespace keyblock::api
