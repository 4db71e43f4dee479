#include "statistics/dependence.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/random.h"
#include "statistics/distributions.h"
#include "statistics/sample.h"

namespace keyblock::statistics {
namespace {

constexpr std::size_t index_groups = 20, most_classes = 6, size_of_class = 16;

bool all_equal(std::span<const double> values) {
  return std::ranges::all_of(values, [&](double value) { return value == values.front(); });
}

std::vector<std::size_t> ascending_order(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return values[k]; });
  return order;
}

std::vector<double> ranks_of(std::span<const double> values) {
  const std::vector<std::size_t> order = ascending_order(values);
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t k = first; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(first + end - 1);
    first = end;
  }
  return ranks;
}

/// Sums of squares and products about the means.
struct Squares {
  double xx = 0.0, yy = 0.0, xy = 0.0;
  Squares(std::span<const double> x, std::span<const double> y) {
    const double centre_x = mean(x), centre_y = mean(y);
    for (std::size_t k = 0; k < x.size(); ++k) {
      xx += (x[k] - centre_x) * (x[k] - centre_x);
      yy += (y[k] - centre_y) * (y[k] - centre_y);
      xy += (x[k] - centre_x) * (y[k] - centre_y);
    }
  }
  [[nodiscard]] double about_line() const { return xx > 0.0 ? std::max(0.0, yy - xy * xy / xx) : yy; }
};

/// Of pairs in the order of x.
double index_of(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size(), classes = std::clamp<std::size_t>(n / size_of_class, 1, most_classes);
  double rest = 0.0;
  for (std::size_t k = 0; k < classes; ++k) {
    const std::size_t from = k * n / classes, to = (k + 1) * n / classes;
    rest += Squares(x.subspan(from, to - from), y.subspan(from, to - from)).about_line();
  }
  const double freedom = static_cast<double>(n - 1) / static_cast<double>(n - 2 * classes);
  return 1.0 - freedom * rest / Squares(x, y).yy;
}

}  // namespace

Estimate rank_correlation(std::span<const double> x, std::span<const double> y, double confidence) {
  if (x.size() < 2 || all_equal(x) || all_equal(y)) return {};
  const std::vector<double> rank_x = ranks_of(x), rank_y = ranks_of(y);
  const Squares squares(rank_x, rank_y);
  const double rho = std::clamp(squares.xy / std::sqrt(squares.xx * squares.yy), -1.0, 1.0);
  constexpr std::size_t smallest = 4;
  if (x.size() < smallest) return {rho, not_a_number, not_a_number};
  const double reach = inverse_normal_cdf(0.5 + 0.5 * confidence) *
                       std::sqrt((1.0 + 0.5 * rho * rho) / static_cast<double>(x.size() - 3));
  return {rho, std::tanh(std::atanh(rho) - reach), std::tanh(std::atanh(rho) + reach)};
}

Estimate first_order_index(std::span<const double> x, std::span<const double> y, double confidence) {
  if (x.size() < smallest_index_sample || all_equal(x) || all_equal(y)) return {};
  const std::vector<std::size_t> order = ascending_order(x);
  const auto without = [&](std::size_t group) {
    std::vector<double> kept_x, kept_y;
    for (const std::size_t k : order) {
      if (k % index_groups == group) continue;
      kept_x.push_back(x[k]);
      kept_y.push_back(y[k]);
    }
    return index_of(kept_x, kept_y);
  };
  const double index = without(index_groups);
  std::vector<double> left_out;
  for (std::size_t group = 0; group < index_groups; ++group) left_out.push_back(without(group));
  const double share = static_cast<double>(index_groups - 1) / static_cast<double>(index_groups),
               deviation =
                   standard_deviation(left_out) * std::sqrt(share * static_cast<double>(index_groups - 1)),
               reach = student_t(confidence, static_cast<int>(index_groups) - 1) * deviation;
  const auto cut = [](double value) { return std::clamp(value, 0.0, 1.0); };
  return {cut(index), cut(index - reach), cut(index + reach)};
}

}  // namespace keyblock::statistics
