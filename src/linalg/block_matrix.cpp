#include "linalg/block_matrix.h"

#include <algorithm>

#include "core/index.h"
#include "linalg/block_kernels.h"

namespace keyblock::linalg {

BlockMatrix::BlockMatrix(const BlockPattern& pattern, std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = pattern.columns();
  std::vector<std::vector<std::size_t>> pairs_of(n);  // by column
  const auto column_and_row = [&](std::size_t k) {
    return std::pair<std::size_t, std::size_t>(
        std::minmax(pattern.position[at(pairs[k].first)], pattern.position[at(pairs[k].second)]));
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) pairs_of[column_and_row(k).first].push_back(k);
  std::vector<std::size_t> value(pairs.size());
  std::size_t used = 0;
  source_start_.assign(1, 0);
  const auto add = [&](std::size_t to, std::size_t row, std::size_t column) {
    const std::size_t count = at(pattern.stride[row] * pattern.size[column]);
    sources_.push_back({used, to, row, count});
    used += count;
    return sources_.back().from;
  };
  for (std::size_t j = 0; j < n; ++j) {
    add(pattern.column_value[j], j, j);
    std::sort(pairs_of[j].begin(), pairs_of[j].end(), [&](std::size_t k, std::size_t l) {
      return column_and_row(k).second < column_and_row(l).second;
    });
    for (const std::size_t k : pairs_of[j]) {
      const std::size_t row = column_and_row(k).second;
      const auto first = pattern.rows.begin() + static_cast<std::ptrdiff_t>(pattern.row_start[j]);
      const auto last = pattern.rows.begin() + static_cast<std::ptrdiff_t>(pattern.row_start[j + 1]);
      const auto entry = static_cast<std::size_t>(std::lower_bound(first, last, row) - pattern.rows.begin());
      value[k] = add(pattern.row_value[entry], row, j);
    }
    source_start_.push_back(sources_.size());
  }
  values_.assign(used, 0.0);
  diagonal_.resize(n);
  for (std::size_t i = 0; i < n; ++i) diagonal_[i] = sources_[source_start_[pattern.position[i]]].from;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const bool i_below = pattern.position[at(i)] > pattern.position[at(j)];
    const std::size_t row = pattern.position[at(i_below ? i : j)];
    slots_.push_back({&values_[value[k]], pattern.stride[row], i_below ? i : j, i_below ? j : i});
  }
}

void BlockMatrix::clear() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

template <typename Number>
void BlockMatrix::load_column(const BlockPattern& pattern, std::size_t j, std::span<Number> values) const {
  std::size_t filled = pattern.column_value[j];
  const auto clear_up_to = [&](std::size_t value) {
    for (; filled < value; filled += row_padding) store(&values[filled], decltype(load(values.data())){});
  };
  for (std::size_t k = source_start_[j]; k < source_start_[j + 1]; ++k) {
    const Source& source = sources_[k];
    clear_up_to(source.to);
    for (std::size_t v = 0; v < source.count; v += row_padding)
      store_rounded(&values[source.to + v], load(&values_[source.from + v]));
    filled += source.count;
  }
  clear_up_to(pattern.column_end(j));
}
template void BlockMatrix::load_column(const BlockPattern&, std::size_t, std::span<float>) const;
template void BlockMatrix::load_column(const BlockPattern&, std::size_t, std::span<double>) const;

void BlockMatrix::subtract_product(const BlockPattern& pattern, std::span<const double> x,
                                   std::span<double> y) const {
  for (std::size_t j = 0; j < pattern.columns(); ++j) {
    const int size = pattern.size[j];
    const double* x_j = &x[pattern.work_start[j]];
    double* y_j = &y[pattern.work_start[j]];
    const double* diagonal = diagonal_of_column(j);
    for (int c = 0; c < size; ++c, diagonal += pattern.stride[j]) {
      double sum = diagonal[c] * x_j[c];
      for (int r = c + 1; r < size; ++r) {
        sum += diagonal[r] * x_j[r];
        y_j[r] -= diagonal[r] * x_j[c];
      }
      y_j[c] -= sum;
    }
    for (std::size_t k = source_start_[j] + 1; k < source_start_[j + 1]; ++k) {
      const Source& source = sources_[k];
      const int stride = pattern.stride[source.row];
      const double *block = &values_[source.from], *x_i = &x[pattern.work_start[source.row]];
      subtract_times(stride / row_padding, size, block, x_j, &y[pattern.work_start[source.row]]);
      subtract_transposed(block, stride, size, x_i, pattern.stride[j], y_j);
    }
  }
}

}  // namespace keyblock::linalg
