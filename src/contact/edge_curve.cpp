#include "contact/edge_curve.h"

#include <utility>

namespace keyblock::contact {

namespace {

/// The coefficients of Π (s − p_i) · scale, i ≠ j, on Bernstein's polynomials of its degree, each factor by its values at 0 and 1.
std::vector<double> bernstein_of_product(const std::vector<double>& points, std::size_t j, double scale) {
  std::vector<double> product{scale};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == j) continue;
    const std::size_t degree = product.size();
    std::vector<double> next(degree + 1, 0.0);
    for (std::size_t k = 0; k < degree; ++k) {
      next[k] -= static_cast<double>(degree - k) / static_cast<double>(degree) * product[k] * points[i];
      next[k + 1] +=
          static_cast<double>(k + 1) / static_cast<double>(degree) * product[k] * (1.0 - points[i]);
    }
    product = std::move(next);
  }
  return product;
}

}  // namespace

EdgeDivision::EdgeDivision(std::vector<double> ascending) : points(std::move(ascending)) {
  for (std::size_t j = 0; j < points.size(); ++j) {
    double product = 1.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i != j) product *= points[j] - points[i];
    }
    scales.push_back(1.0 / product);
  }
  bernstein.resize(points.size() * points.size());
  for (std::size_t j = 0; j < points.size(); ++j) {
    const std::vector<double> column = bernstein_of_product(points, j, scales[j]);
    for (std::size_t i = 0; i < points.size(); ++i) bernstein[i * points.size() + j] = column[i];
  }
}

}  // namespace keyblock::contact
