#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace keyblock::study {

/// Whether the criterion holds at a value, or nothing where no trial has told.
using Known = std::function<std::optional<bool>(double)>;

/// A bisection between a value at which a criterion should not hold and one at which it should. Which values it tries depends on
/// the answers alone, never on how many are tried at a time.
class Bisection {
 public:
  enum class Status {
    open,          ///< the next trial is not known yet
    found,         ///< the bracket is narrow enough
    met_at_both,   ///< the criterion holds at `from` as well
    met_at_none,   ///< it does not hold at `to`
    ends_swapped,  ///< it holds at `from` and not at `to`
  };

  struct State {
    Status status = Status::open;
    double not_met = 0.0, met = 0.0;  ///< the bracket, as far as it is known
    std::vector<double> path;         ///< the values tried, both ends first
  };

  /// The bracket is narrow enough when it is at most `tolerance` times the larger of its ends, or a millionth of the whole.
  Bisection(double from, double to, double tolerance);

  /// As far as what is known leads.
  [[nodiscard]] State follow(const Known& known) const;

  /// Up to `count` values to be tried now: the one that comes next (both ends at first), then those that may come after it, nearest
  /// first. Empty when the bisection has ended.
  [[nodiscard]] std::vector<double> next(const Known& known, std::size_t count) const;

 private:
  struct Bracket {
    double not_met, met;
  };
  [[nodiscard]] bool is_narrow(const Bracket& bracket) const;
  static double middle(const Bracket& bracket) { return 0.5 * (bracket.not_met + bracket.met); }

  double from_, to_, tolerance_;
};

}  // namespace keyblock::study
