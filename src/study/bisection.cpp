#include "study/bisection.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace keyblock::study {
namespace {

constexpr double narrowest = 1e-6;  // of the whole: where the limit is zero, no bracket is narrow by its ends

}  // namespace

Bisection::Bisection(double from, double to, double tolerance)
    : from_(from), to_(to), tolerance_(tolerance) {}

bool Bisection::is_narrow(const Bracket& b) const {
  const double size = std::max(std::abs(b.not_met), std::abs(b.met));
  return std::abs(b.met - b.not_met) <= std::max(tolerance_ * size, narrowest * std::abs(to_ - from_));
}

Bisection::State Bisection::follow(const Known& known) const {
  State state{Status::open, from_, to_, {}};
  const auto at_from = known(from_), at_to = known(to_);
  if (at_from) state.path.push_back(from_);
  if (at_to) state.path.push_back(to_);
  if (!at_from || !at_to) return state;
  if (*at_from) {
    state.status = *at_to ? Status::met_at_both : Status::ends_swapped;
    return state;
  }
  if (!*at_to) {
    state.status = Status::met_at_none;
    return state;
  }
  Bracket bracket{from_, to_};
  while (!is_narrow(bracket)) {
    const double value = middle(bracket);
    const auto met = known(value);
    if (!met) return state;
    state.path.push_back(value);
    (*met ? bracket.met : bracket.not_met) = value;
    state.not_met = bracket.not_met;
    state.met = bracket.met;
  }
  state.status = Status::found;
  return state;
}

std::vector<double> Bisection::next(const Known& known, std::size_t count) const {
  std::vector<double> values;
  if (follow(known).status != Status::open) return values;
  for (const double end : {from_, to_}) {
    if (!known(end)) values.push_back(end);
  }
  std::deque<Bracket> brackets{{from_, to_}};
  while (!brackets.empty() && values.size() < count) {
    const Bracket bracket = brackets.front();
    brackets.pop_front();
    if (is_narrow(bracket)) continue;
    const double value = middle(bracket);
    const auto met = known(value);
    if (!met) values.push_back(value);
    if (!met || *met) brackets.push_back({bracket.not_met, value});
    if (!met || !*met) brackets.push_back({value, bracket.met});
  }
  return values;
}

}  // namespace keyblock::study
