#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "verification/table_columns.h"

namespace keyblock::verification {
namespace {

constexpr double percent_below = 1e-5;  // smaller relative errors are written as powers

std::string figure(double x) {
  return std::isfinite(x) ? fmt::format("{:.7g}", x) : "-";
}

std::string relative(double x) {
  if (x == 0.0) return "0";
  return std::abs(x) < percent_below ? fmt::format("{:.1e}", x) : fmt::format("{:.3g} %", 100.0 * x);
}

std::string with_sign(const std::string& text) {
  return text == "0" || text.front() == '-' ? text : "+" + text;
}

}  // namespace

RowText row_text(const Row& row) {
  RowText text;
  text.run = row.run;
  text.quantity = row.unit.empty() ? row.quantity : fmt::format("{}, {}", row.quantity, row.unit);
  if (row.order) text.order = std::to_string(*row.order);
  text.parameters = row.label;
  text.computed = figure(row.computed);
  if (row.expected) text.expected = figure(*row.expected);
  if (row.at_most) text.expected = "≤ " + figure(*row.at_most);
  if (row.at_least) text.expected = "≥ " + figure(*row.at_least);
  const bool number = std::isfinite(row.computed) && row.expected;
  if (number && row.absolute_tolerance) {
    text.error = with_sign(fmt::format("{:.2g}", row.computed - *row.expected));
  } else if (number && row.relative_error) {
    text.error = with_sign(relative(*row.relative_error));
  }
  if (row.published) text.published = figure(*row.published);
  if (row.tolerance) text.tolerance = relative(*row.tolerance);
  if (row.absolute_tolerance) text.tolerance = fmt::format("± {:.3g}", *row.absolute_tolerance);
  text.note = row.failure;
  return text;
}

std::array<bool, table_columns.size()> used_columns(const CaseResult& result) {
  std::array<bool, table_columns.size()> used{};
  for (const Row& row : result.rows) {
    const RowText text = row_text(row);
    for (std::size_t c = 0; c < table_columns.size(); ++c) {
      used[c] = used[c] || !(text.*table_columns[c].cell).empty();
    }
  }
  used[0] = std::any_of(result.rows.begin(), result.rows.end(),
                        [&](const Row& row) { return row.run != result.rows.front().run; });
  return used;
}

std::string verdict_text(const std::vector<CaseResult>& results) {
  std::size_t rows = 0, failed = 0, cases = 0;
  for (const CaseResult& result : results) {
    cases += !result.rows.empty();
    rows += result.rows.size();
    failed += static_cast<std::size_t>(result.failed());
  }
  const std::string what = fmt::format("{} rows of {} cases", rows, cases);
  return failed == 0 ? fmt::format("all {} hold", what) : fmt::format("{} of {} do not hold", failed, what);
}

}  // namespace keyblock::verification
