#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "statistics/interval.h"

namespace keyblock::study {

/// Strengths of a realization that were drawn: names and values (RunResult::strengths).
using Strengths = std::vector<std::pair<std::string, double>>;

/// How far a number of many realizations hangs on a strength that was drawn (statistics/dependence.h).
struct Dependence {
  std::string strength;  ///< "bedding.friction"
  statistics::Estimate rank_correlation, first_order;
};
/// Of all strengths that differ from realization to realization, those of the largest rank correlation first; strengths[k] and numbers[k] are of one
/// realization. None where a realization lacks a strength, or where all numbers are equal.
std::vector<Dependence> dependences(std::span<const Strengths* const> strengths,
                                    std::span<const double> numbers, double confidence);

/// A strength in words: "friction of “bedding”".
std::string strength_title(const std::string& name);

}  // namespace keyblock::study
