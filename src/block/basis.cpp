#include "block/basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/index.h"

namespace keyblock::block {

namespace {

constexpr int linear_size = basis_size(1);

using Values = std::vector<double>;  ///< of a polynomial at the points of a rule

double product(const Values& a, const Values& b, const std::vector<WeightedPoint>& rule) {
  double sum = 0.0;
  for (std::size_t q = 0; q < rule.size(); ++q) sum += rule[q].weight * a[q] * b[q];
  return sum;
}

/// A product of polynomials that may become the next one of the basis.
struct Candidate {
  Basis::Product of;
  Values left;            ///< what is left of it beside the polynomials before
  std::vector<double> h;  ///< shares of these

  void take_off(const std::vector<Values>& phi, std::size_t j, const std::vector<WeightedPoint>& rule) {
    const double shared = product(phi[j], left, rule);
    h[j] += shared;
    for (std::size_t q = 0; q < left.size(); ++q) left[q] -= shared * phi[j][q];
  }
  void take_off_all(const std::vector<Values>& phi, const std::vector<WeightedPoint>& rule) {
    h.resize(phi.size(), 0.0);
    for (std::size_t j = 0; j < phi.size(); ++j) take_off(phi, j, rule);
  }
};

/// Those of degree d, from the polynomials of all lower degrees.
std::vector<Candidate> candidates_of(int degree, const std::vector<Values>& phi,
                                     const std::vector<WeightedPoint>& rule) {
  std::vector<Candidate> candidates;
  for (int parent = basis_size(degree - 2); parent < basis_size(degree - 1); ++parent) {
    for (const int factor : {1, 2}) {
      Candidate candidate{{parent, factor}, phi[at(parent)], {}};
      for (std::size_t q = 0; q < rule.size(); ++q) candidate.left[q] *= phi[at(factor)][q] / phi[0][q];
      candidate.take_off_all(phi, rule);
      candidates.push_back(std::move(candidate));
    }
  }
  return candidates;
}

/// Takes out the one of which most is left.
Candidate take_largest(std::vector<Candidate>& candidates, const std::vector<WeightedPoint>& rule) {
  const auto largest =
      std::max_element(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
        return product(a.left, a.left, rule) < product(b.left, b.left, rule);
      });
  Candidate taken = std::move(*largest);
  candidates.erase(largest);
  return taken;
}

using Square = std::array<std::array<double, 3>, 3>;

/// G = R Rᵀ, in place: the lower triangle becomes R.
void factor_gram(Square& gram) {
  constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < gram.size(); ++i) {
    const double whole = gram[i][i];
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = gram[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= gram[i][k] * gram[j][k];
      // The sum of those before it except for rounding.
      if (i == j && !(sum > rounding * whole)) throw std::invalid_argument("Basis: a region without width");
      gram[i][j] = i == j ? std::sqrt(sum) : sum / gram[j][j];
    }
  }
}

}  // namespace

Basis::Basis(const Polygon& region, int order) : order_(order), size_(basis_size(order)) {
  if (order < 1) throw std::invalid_argument("a displacement polynomial has order 1 or higher");
  if (!(area(region) > 0.0)) throw std::invalid_argument("a block needs an area");
  const Box box = bounds(region);
  centre_ = 0.5 * (box.min + box.max);
  half_size_ = 0.5 * box.size();
  for (std::size_t i = 0; i < linear_.size(); ++i) linear_[i][i] = 1.0;
  // Each degree is made by a rule that is exact for it, so that a basis begins with those of lower orders to the last bit.
  const std::vector<WeightedPoint> rule = polygon_rule(region, 2);
  // The second pass restores what the first loses for thin and inclined regions.
  orthonormalize_linear(rule);
  orthonormalize_linear(rule);
  for (int degree = 2; degree <= order; ++degree) append_degree(degree, polygon_rule(region, 2 * degree));

  identity_.assign(at(size_), Vec2{});
  std::array<double, linear_size> phi;
  for (const WeightedPoint& w : rule) {
    evaluate_linear(w.point, phi.data());
    for (std::size_t k = 0; k < phi.size(); ++k) identity_[k] += w.weight * phi[k] * w.point;
  }
}

// With Gram matrix G = R Rᵀ of the present functions, R⁻¹ times them is orthonormal.
void Basis::orthonormalize_linear(const std::vector<WeightedPoint>& rule) {
  Linear gram{};
  std::array<double, linear_size> phi;
  for (const WeightedPoint& w : rule) {
    evaluate_linear(w.point, phi.data());
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const double weighted = w.weight * phi[i];
      for (std::size_t j = 0; j <= i; ++j) gram[i][j] += weighted * phi[j];
    }
  }
  factor_gram(gram);
  // Forward substitution, row by row: coefficients ← R⁻¹ coefficients.
  for (std::size_t i = 0; i < gram.size(); ++i) {
    for (std::size_t column = 0; column <= i; ++column) {
      double sum = linear_[i][column];
      for (std::size_t k = column; k < i; ++k) sum -= gram[i][k] * linear_[k][column];
      linear_[i][column] = sum / gram[i][i];
    }
  }
}

// Of the 2 d products of φ_1 and φ_2 with the polynomials of degree d − 1, the d + 1 that are told best from each other: each
// time the one of which most is left beside those before it (Gram and Schmidt's method with pivots, twice for the chosen ones).
void Basis::append_degree(int degree, const std::vector<WeightedPoint>& rule) {
  constexpr double least_left = 1e-10;
  std::vector<Values> phi = values_at(rule);
  std::vector<Candidate> candidates = candidates_of(degree, phi, rule);
  for (int chosen = 0; chosen <= degree; ++chosen) {
    Candidate next = take_largest(candidates, rule);
    next.take_off_all(phi, rule);
    const double size = std::sqrt(product(next.left, next.left, rule));
    if (!(size > least_left))
      throw std::invalid_argument("Basis: a polynomial of the order vanishes on the region");
    for (double& x : next.left) x /= size;
    products_.push_back(next.of);
    recurrence_.insert(recurrence_.end(), next.h.begin(), next.h.end());
    recurrence_.push_back(size);
    phi.push_back(std::move(next.left));
    for (Candidate& candidate : candidates) {
      candidate.h.push_back(0.0);
      candidate.take_off(phi, phi.size() - 1, rule);
    }
  }
}

/// Of the polynomials that there are, at the points of a rule.
std::vector<std::vector<double>> Basis::values_at(const std::vector<WeightedPoint>& rule) const {
  std::vector<Values> values(linear_size + products_.size(), Values(rule.size()));
  std::vector<double> phi(values.size());
  for (std::size_t q = 0; q < rule.size(); ++q) {
    evaluate(rule[q].point, phi.data());
    for (std::size_t k = 0; k < phi.size(); ++k) values[k][q] = phi[k];
  }
  return values;
}

void Basis::evaluate_linear(Vec2 point, double* phi) const {
  const std::array<double, linear_size> p{1.0, (point.x - centre_.x) / half_size_.x,
                                          (point.y - centre_.y) / half_size_.y};
  for (std::size_t i = 0; i < p.size(); ++i) {
    phi[i] = 0.0;
    for (std::size_t j = 0; j <= i; ++j) phi[i] += linear_[i][j] * p[j];
  }
}

void Basis::evaluate(Vec2 point, double* phi) const {
  evaluate_linear(point, phi);
  const double* h = recurrence_.data();
  int k = linear_size;
  for (const Product of : products_) {
    double sum = phi[of.factor] / phi[0] * phi[of.parent];
    for (int j = 0; j < k; ++j) sum -= *h++ * phi[j];
    phi[k++] = sum / *h++;
  }
}

void Basis::gradients(Vec2 point, Vec2* gradient) const {
  gradient[0] = {};
  gradient[1] = {linear_[1][1] * (1.0 / half_size_.x), 0.0};
  gradient[2] = {linear_[2][1] * (1.0 / half_size_.x), linear_[2][2] * (1.0 / half_size_.y)};
  if (order_ == 1) return;
  std::vector<double> phi(at(size_));
  evaluate(point, phi.data());
  const double* h = recurrence_.data();
  int k = linear_size;
  for (const Product of : products_) {
    Vec2 sum =
        phi[at(of.factor)] / phi[0] * gradient[of.parent] + phi[at(of.parent)] / phi[0] * gradient[of.factor];
    for (int j = 0; j < k; ++j) sum -= *h++ * gradient[j];
    gradient[k++] = sum / *h++;
  }
}

std::vector<Vec2> Basis::identity() const {
  return identity_;
}

}  // namespace keyblock::block
