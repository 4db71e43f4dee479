#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace keyblock::report {

/// Indices, ascending, of at most about `limit` of n things recorded in order, stage_of[i] the stage of thing
/// i: the first and last of every stage always (even beyond the limit), the others evenly.
std::vector<std::size_t> thin_by_stage(std::span<const int> stage_of, std::size_t limit);

/// Curves over a common abscissa; NaN where a curve has no value.
struct Curves {
  std::vector<double> x;
  std::vector<std::vector<double>> columns;  ///< columns[c][i] belongs to x[i]
};

/// At most about `limit` points that look the same when plotted: rows are put into buckets, and each bucket
/// gives two points, at its first and last x, which hold every column's smallest and largest value in the
/// order in which they occur. The first and the last row stay as they are.
Curves thin_curves(const Curves& curves, std::size_t limit);

}  // namespace keyblock::report
