#pragma once
#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

namespace keyblock::study {

/// Whether the criterion holds at a value, or nothing where no trial has told.
using Known = std::function<std::optional<bool>(double)>;

/// A bisection between a value at which a criterion should not hold and one at which it should. Which values it tries depends on
/// the answers alone, never on how many are tried at a time.
///
/// With a scan of N, values that divide the way into N equal parts are tried before. Between two neighbours of which one holds and the other
/// does not there is a limit: each is bisected, as the criterion need not hold all the way beyond the first. What lies between two
/// neighbours that are alike is not seen.
class Bisection {
 public:
  enum class Status {
    open,          ///< the next trial is not known yet
    found,         ///< all brackets are narrow enough
    met_at_both,   ///< the criterion holds at `from` as well
    met_at_none,   ///< it holds at no value that was tried
    ends_swapped,  ///< it holds at `from` and not at `to`
  };

  /// Two values between which there is a limit.
  struct Bracket {
    double not_met = 0.0, met = 0.0;
    [[nodiscard]] double middle() const { return 0.5 * (not_met + met); }
  };

  struct State {
    Status status = Status::open;
    double not_met = 0.0,
           met = 0.0;  ///< the bracket at which it begins to hold, from `from` on; as far as it is known
    std::vector<double> path{};     ///< the values tried, both ends first, then those of the scan
    std::vector<Bracket> limits{};  ///< all, from `from` on: where it begins to hold and where it ends to
  };

  /// What is to be tried.
  struct Next {
    std::vector<double> values;  ///< what comes next, then what may come after it, nearest first
    std::size_t needed = 0;      ///< so many of them in any case
  };

  /// A bracket is narrow enough when it is at most `tolerance` times the larger of its ends, or a millionth of the whole.
  /// `also`, between the ends, is tried with them: no bracket holds it.
  Bisection(double from, double to, double tolerance, int scan = 1, std::optional<double> also = {});

  /// As far as what is known leads.
  [[nodiscard]] State follow(const Known& known) const;

  /// At least what is needed, and up to `count` values. Empty when the bisection has ended.
  [[nodiscard]] Next next(const Known& known, std::size_t count) const;

 private:
  [[nodiscard]] bool is_narrow(const Bracket& bracket) const;
  /// Brackets between neighbours of the scan, all of which are known.
  [[nodiscard]] std::vector<Bracket> crossings(const Known& known) const;
  [[nodiscard]] Status status_without_onset(const Known& known) const;
  [[nodiscard]] std::vector<double> needed(const Known& known, std::deque<Bracket>& later) const;
  std::optional<double> narrow(Bracket& bracket, const Known& known, std::vector<double>& path) const;

  double from_, to_, tolerance_;
  bool scans_;
  std::vector<double> scan_;      ///< from `from` to `to`
  std::vector<double> in_order_;  ///< the same, both ends first
};

}  // namespace keyblock::study
