#include "contact/edge_curve.h"

#include <utility>

namespace keyblock::contact {

EdgeDivision::EdgeDivision(std::vector<double> ascending) : points(std::move(ascending)) {
  for (std::size_t j = 0; j < points.size(); ++j) {
    double product = 1.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i != j) product *= points[j] - points[i];
    }
    scales.push_back(1.0 / product);
  }
}

}  // namespace keyblock::contact
