#include "study/bisection.h"

#include <algorithm>
#include <cmath>

namespace keyblock::study {
namespace {

constexpr double narrowest = 1e-6;  // of the whole: where the limit is zero, no bracket is narrow by its ends

}  // namespace

Bisection::Bisection(double from, double to, double tolerance, int scan, std::optional<double> also)
    : from_(from), to_(to), tolerance_(tolerance), scans_(scan > 1) {
  scan_.push_back(from);
  for (int k = 1; k < scan; ++k) scan_.push_back(from + (to - from) * k / scan);
  scan_.push_back(to);
  if (also && (*also - from) * (to - *also) > 0.0 && std::ranges::find(scan_, *also) == scan_.end())
    scan_.insert(
        std::ranges::find_if(scan_, [&](double value) { return (value - *also) * (to - from) > 0.0; }),
        *also);
  in_order_ = {from, to};
  in_order_.insert(in_order_.end(), scan_.begin() + 1, scan_.end() - 1);
}

bool Bisection::is_narrow(const Bracket& b) const {
  const double size = std::max(std::abs(b.not_met), std::abs(b.met));
  return std::abs(b.met - b.not_met) <= std::max(tolerance_ * size, narrowest * std::abs(to_ - from_));
}

std::vector<Bisection::Bracket> Bisection::crossings(const Known& known) const {
  std::vector<Bracket> all;
  for (std::size_t k = 0; k + 1 < scan_.size(); ++k) {
    const bool before = *known(scan_[k]), after = *known(scan_[k + 1]);
    if (before == after) continue;
    all.push_back(before ? Bracket{scan_[k + 1], scan_[k]} : Bracket{scan_[k], scan_[k + 1]});
  }
  // Ends the wrong way round are a slip, unless it was asked what is between them.
  if (!scans_ && *known(from_)) all.clear();
  return all;
}

Bisection::Status Bisection::status_without_onset(const Known& known) const {
  if (!*known(from_)) return Status::met_at_none;
  return *known(to_) ? Status::met_at_both : Status::ends_swapped;
}

/// Narrows a bracket as far as what is known leads, and notes the values on the way. The value that is missing then, if any is.
std::optional<double> Bisection::narrow(Bracket& bracket, const Known& known,
                                        std::vector<double>& path) const {
  while (!is_narrow(bracket)) {
    const double value = bracket.middle();
    const auto met = known(value);
    if (!met) return value;
    path.push_back(value);
    (*met ? bracket.met : bracket.not_met) = value;
  }
  return std::nullopt;
}

Bisection::State Bisection::follow(const Known& known) const {
  State state{Status::open, from_, to_};
  bool all_known = true;
  for (const double value : in_order_) {
    if (known(value)) {
      state.path.push_back(value);
    } else {
      all_known = false;
    }
  }
  if (!all_known) return state;
  state.limits = crossings(known);
  for (Bracket& bracket : state.limits)
    if (narrow(bracket, known, state.path)) all_known = false;
  const bool onset = !*known(from_) && !state.limits.empty();
  if (onset) {
    state.not_met = state.limits.front().not_met;
    state.met = state.limits.front().met;
  }
  if (all_known) state.status = onset ? Status::found : status_without_onset(known);
  return state;
}

/// Values that are needed in any case, and the brackets that come after them.
std::vector<double> Bisection::needed(const Known& known, std::deque<Bracket>& later) const {
  std::vector<double> values;
  for (const double value : in_order_)
    if (!known(value)) values.push_back(value);
  if (!values.empty()) {
    if (scan_.size() == 2) later.push_back({from_, to_});
    return values;
  }
  std::vector<double> path;
  for (Bracket bracket : crossings(known)) {
    const auto missing = narrow(bracket, known, path);
    if (!missing) continue;
    values.push_back(*missing);
    later.push_back({bracket.not_met, *missing});
    later.push_back({*missing, bracket.met});
  }
  return values;
}

Bisection::Next Bisection::next(const Known& known, std::size_t count) const {
  std::deque<Bracket> later;
  Next next{needed(known, later)};
  next.needed = next.values.size();
  while (!later.empty() && next.values.size() < count) {
    const Bracket bracket = later.front();
    later.pop_front();
    if (is_narrow(bracket)) continue;
    const double value = bracket.middle();
    const auto met = known(value);
    if (!met) next.values.push_back(value);
    if (!met || *met) later.push_back({bracket.not_met, value});
    if (!met || !*met) later.push_back({value, bracket.met});
  }
  return next;
}

}  // namespace keyblock::study
