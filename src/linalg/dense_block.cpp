#include "linalg/dense_block.h"

#include <vector>

#include "core/index.h"
#include "linalg/block_kernels.h"

namespace keyblock::linalg {

bool solve_block(int n, const double* a, double* x) {
  const int stride = padded_rows(n);
  std::vector<double> inverse(a, a + stride * n), forward(at(n), 0.0), scale(at(n));  // L⁻¹, L⁻¹ x
  if (!invert_factor(n, inverse.data(), scale.data())) return false;
  for (int c = 0; c < n; ++c) {
    for (int r = c; r < n; ++r) forward[at(r)] += inverse[at(c * stride + r)] * x[c];
  }
  for (int c = 0; c < n; ++c) {
    x[c] = 0.0;
    for (int r = c; r < n; ++r) x[c] += inverse[at(c * stride + r)] * forward[at(r)];
  }
  return true;
}

}  // namespace keyblock::linalg
