#pragma once
#include <atomic>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "verification/case_file.h"
#include "verification/rows.h"

namespace keyblock::verification {

struct VerifyOptions {
  bool all = false;      ///< long cases and runs too
  std::set<int> orders;  ///< only simulations of these orders; empty: all
  int workers = 1;       ///< simulations at once, one thread each
  std::string version;
  const std::atomic<bool>* stop = nullptr;
};

/// A case with its rows; without rows where all its runs were left out.
struct CaseResult {
  const CaseFile* file = nullptr;
  std::vector<Row> rows;
  double wall_time = 0.0;  ///< s, of its simulations together

  [[nodiscard]] int failed() const;
};

/// How far the work has come. Called by one thread at a time.
using VerifyProgress =
    std::function<void(std::size_t done, std::size_t count, const CaseFile& last, const RunSpec& run)>;

/// Runs the simulations of all cases and makes their rows, in the order of `cases` for any number of workers. Throws
/// InputError when a scenario is wrong, RunError when it was interrupted.
std::vector<CaseResult> verify(const std::vector<CaseFile>& cases, const VerifyOptions& options,
                               const VerifyProgress& progress);

}  // namespace keyblock::verification
