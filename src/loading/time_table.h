#pragma once
#include <optional>
#include <utility>
#include <vector>

namespace keyblock::loading {

/// A quantity over time, linear between rows and held outside. Rows ascend in time.
class TimeTable {
 public:
  TimeTable() = default;
  explicit TimeTable(std::vector<std::pair<double, double>> rows) : rows_(std::move(rows)) {}
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  [[nodiscard]] double operator()(double time) const;
  /// s, after which it is what it ends with, within 1e-6 of the largest value; none: it never changes.
  [[nodiscard]] std::optional<double> last_change() const;
  [[nodiscard]] const std::vector<std::pair<double, double>>& rows() const { return rows_; }

 private:
  std::vector<std::pair<double, double>> rows_;
};

}  // namespace keyblock::loading
