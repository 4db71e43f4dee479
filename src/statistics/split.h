#pragma once
#include <span>
#include <vector>

#include "statistics/interval.h"

/// Of the scatter β of a fragility curve: what of it is from rock mass to rock mass, from record to record, and of the pair alone.
///
///   ln C_ij = ln θ + G_i + R_j + E_ij,     β² = σ_rock² + σ_record² + σ_rest²
///
/// C_ij is the capacity of rock mass i under record j, the weakest shaking by which the level is exceeded. Runs tell between which
/// intensities it lies. Two pairs that share the rock mass have capacities of correlation ρ = σ_rock²/β², two that share the record of
/// σ_record²/β². Each ρ is the likeliest for the table of all such two pairs, by the first intensity that exceeds the level
/// (polychoric correlation, Olsson 1979):
///
///   ln L(ρ) = Σ n_ab ln [Φ₂ over the cell a, b; ρ],     thresholds t_k = ln(x_k/θ)/β
namespace keyblock::statistics {

/// Φ₂(h, k; ρ): both of two standard normal numbers of correlation ρ are below h and k. Plackett's integral over the angle, by Gauss and
/// Legendre with 24 points (Drezner & Wesolowsky 1990); |ρ| ≤ 0.985.
double bivariate_normal_cdf(double h, double k, double rho);

/// A rock mass under a record.
struct Pair {
  int rock = 0, record = 0;
  std::size_t first =
      0;  ///< place of the weakest intensity that exceeds the level; as many as there are: none does
};

/// ρ of those that share the rock, and of those that share the record. Not a number where no two do.
struct SharedCorrelations {
  double rock = not_a_number, record = not_a_number;
};

/// thresholds: t_k, ascending. Found on 60 places from −0.3 to 0.985, then to 1e-10.
SharedCorrelations shared_correlations(std::span<const Pair> pairs, std::span<const double> thresholds);

/// The same from a start that is near, by one step of Newton: for what is left out one by one.
SharedCorrelations near_correlations(std::span<const Pair> pairs, std::span<const double> thresholds,
                                     const SharedCorrelations& start);

}  // namespace keyblock::statistics
