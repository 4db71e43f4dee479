#pragma once
#include "keyblock/scenario.h"
#include "scenario/scenario.h"
#include "scenario/value.h"

namespace keyblock::api {

/// Read and checked. Throws InputError.
scenario::Scenario parsed(const Scenario& scenario);

/// Between the values of the public headers and those of documents. What is put into a document says so in the place of a file.
scenario::Value document_value(const Value& value);
Value public_value(const scenario::Value& value);

}  // namespace keyblock::api
