#pragma once
#include "keyblock/error.h"
#include "keyblock/results.h"
#include "keyblock/scenario.h"
#include "keyblock/simulation.h"
#include "keyblock/study.h"
#include "keyblock/value.h"
#include "keyblock/verify.h"

namespace keyblock {

/// `0.1.0`
KEYBLOCK_API const char* version();

}  // namespace keyblock
