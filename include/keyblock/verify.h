#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "keyblock/error.h"
#include "keyblock/export.h"

namespace keyblock {

/// What `keyblock verify` is asked for.
struct VerifyRequest {
  std::filesystem::path cases;     ///< folder of the case files
  std::vector<std::string> names;  ///< of case files; empty: all but the long ones
  std::vector<int> orders;         ///< of the displacement; empty: all
  bool all = false;                ///< the long ones, too
  int workers = 1;                 ///< simulations at once, one thread each
  /// Told of simulations that have ended and of all; false stops it.
  std::function<bool(std::size_t ended, std::size_t of)> progress;
};

/// Solves problems with known answers, and compares: the table as JSON (docs/verification.md). Throws InputError for an unknown name, and RunError
/// where it was stopped.
KEYBLOCK_API std::string verify(const VerifyRequest& request);

}  // namespace keyblock
