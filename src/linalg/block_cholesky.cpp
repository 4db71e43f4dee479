#include <algorithm>

#include "core/huge_pages.h"
#include "core/index.h"
#include "linalg/block_kernels.h"
#include "linalg/block_solver.h"
#include "linalg/minimum_degree.h"

namespace keyblock::linalg {

namespace {

class BlockCholesky final : public BlockSolver, public HalfSolver {
 public:
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override {
    std::fill(matrix_.begin(), matrix_.end(), 0.0);
    std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  }
  double* diagonal(int block) override { return &matrix_[diagonal_[at(block)]]; }
  BlockSlot slot(int pair) override { return slots_[at(pair)]; }
  void touch(int block) override { stale_[position_[at(block)]] = 1; }
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess) override;
  HalfSolver* halves() override { return this; }
  void half_solve(Part a, Part b, HalfSolution& half) override;
  void half_solve(std::span<const double> b, std::vector<double>& half) override;
  [[nodiscard]] double product(const HalfSolution& x, const HalfSolution& y) const override;
  [[nodiscard]] double product(const HalfSolution& x, std::span<const double> y) const override;
  void finish(std::span<const double> half, std::span<const HalfSolution> halves,
              std::span<const double> factor, std::span<double> x) override;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  void find_structure(std::span<const std::pair<int, int>> pairs);
  void place_values();
  void place_matrix(std::span<const std::pair<int, int>> pairs);
  void load_column(std::size_t j);
  // `equal`: unknowns of every block where all have as many, so that loops have a known length; 0 where not.
  template <int equal>
  [[nodiscard]] int size(std::size_t column) const {
    return equal > 0 ? equal : size_[column];
  }
  template <int equal>
  [[nodiscard]] int stride(std::size_t column) const {
    return equal > 0 ? padded_rows(equal) : stride_[column];
  }
  template <int equal>
  void update_column(std::size_t j);
  template <int equal>
  bool factor_columns();
  template <int equal, int columns>
  int gather(std::size_t j, int c);
  template <int equal, int columns>
  int divide(std::size_t j, int c);
  template <int equal, typename OfRow>
  void eliminate(std::size_t j, double* y, const OfRow& of_row);
  template <int equal>
  void forward();
  template <int equal>
  void backward();
  template <int equal>
  void half_forward(HalfSolution& half);
  void take(std::span<const double> x);
  void give(std::span<double> x) const;
  template <typename Do>
  void for_equal_size(const Do& what) const;

  // Column j of the factor has its diagonal block first, then rows_[row_start_[j] … row_start_[j+1]),
  // ascending.
  std::vector<std::size_t> position_;   ///< block → column
  int equal_size_ = 0;                  ///< of all columns; 0: they differ
  std::vector<int> size_, stride_;      ///< per column
  std::vector<std::size_t> parent_;     ///< per column, in the elimination tree; none: a root
  std::vector<std::size_t> above_;      ///< per column: padded unknowns of all columns above it in that tree
  std::vector<std::size_t> row_start_;  ///< per column, into rows_ and row_value_
  std::vector<std::size_t> rows_;
  std::vector<std::size_t> row_value_;     ///< per row entry, into values_
  std::vector<std::size_t> column_value_;  ///< per column: the diagonal block, into values_
  struct Update {
    std::size_t column;  ///< k < j with a block in row j
    std::size_t entry;   ///< that block, into rows_
  };
  std::vector<std::size_t> update_start_;  ///< per column, into updates_
  std::vector<Update> updates_;
  HugePageVector<double> values_;    ///< diagonal blocks are L_jj⁻¹
  std::vector<std::size_t> offset_;  ///< per column: start of its unknowns in x, as the caller orders them
  std::vector<std::size_t> work_start_;        ///< per column: start in work_, padded
  std::vector<double> work_, solved_, scale_;  ///< scratch; the last two of one block
  std::vector<double*> target_;  ///< scratch of update_column: row → block of the column at hand
  // The matrix itself: diagonal blocks, and below them the blocks of the pattern, column by column.
  struct Source {
    std::size_t from, to;  ///< into matrix_ and values_
    std::size_t count;
  };
  HugePageVector<double> matrix_;
  std::vector<std::size_t> diagonal_;      ///< per block, into matrix_
  std::vector<Source> sources_;            ///< by column
  std::vector<std::size_t> source_start_;  ///< per column, into sources_
  std::vector<BlockSlot> slots_;
  std::vector<std::uint8_t> stale_;  ///< per column: to be factored anew
};

void BlockCholesky::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = sizes.size();
  const std::vector<int> order = approximate_minimum_degree(static_cast<int>(n), pairs).order;
  position_.assign(n, 0);
  size_.assign(n, 0);
  stride_.assign(n, 0);
  offset_.assign(n, 0);
  std::vector<std::size_t> start(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) start[i + 1] = start[i] + at(sizes[i]);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t block = at(order[k]);
    position_[block] = k;
    size_[k] = sizes[block];
    stride_[k] = padded_rows(sizes[block]);
    offset_[k] = start[block];
  }
  equal_size_ = n > 0 && std::all_of(sizes.begin(), sizes.end(), [&](int size) { return size == sizes[0]; })
                    ? sizes[0]
                    : 0;
  find_structure(pairs);
  place_values();
  place_matrix(pairs);
}

void BlockCholesky::place_matrix(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = size_.size();
  std::vector<std::vector<std::size_t>> pairs_of(n);  // by column
  const auto column_and_row = [&](std::size_t k) {
    return std::pair<std::size_t, std::size_t>(
        std::minmax(position_[at(pairs[k].first)], position_[at(pairs[k].second)]));
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) pairs_of[column_and_row(k).first].push_back(k);
  std::vector<std::size_t> place(pairs.size()), by_column(n);
  std::size_t used = 0;
  sources_.clear();
  source_start_.assign(1, 0);
  const auto add = [&](std::size_t to, int count) {
    sources_.push_back({used, to, at(count)});
    used += at(count);
    return sources_.back().from;
  };
  for (std::size_t j = 0; j < n; ++j) {
    by_column[j] = add(column_value_[j], stride_[j] * size_[j]);
    std::sort(pairs_of[j].begin(), pairs_of[j].end(), [&](std::size_t k, std::size_t l) {
      return column_and_row(k).second < column_and_row(l).second;
    });
    for (const std::size_t k : pairs_of[j]) {
      const std::size_t row = column_and_row(k).second;
      const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(row_start_[j]);
      const auto last = rows_.begin() + static_cast<std::ptrdiff_t>(row_start_[j + 1]);
      const auto entry = static_cast<std::size_t>(std::lower_bound(first, last, row) - rows_.begin());
      place[k] = add(row_value_[entry], stride_[row] * size_[j]);
    }
    source_start_.push_back(sources_.size());
  }
  matrix_.assign(used, 0.0);
  stale_.assign(n, 1);
  diagonal_.resize(n);
  for (std::size_t i = 0; i < n; ++i) diagonal_[i] = by_column[position_[i]];
  slots_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const bool i_below = position_[at(i)] > position_[at(j)];
    const std::size_t row = position_[at(i_below ? i : j)];
    slots_.push_back({&matrix_[place[k]], stride_[row], i_below ? i : j, i_below ? j : i});
  }
}

// Row structure of every column: its own entries and those of the columns whose parent it is (elimination
// tree).
void BlockCholesky::find_structure(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = size_.size();
  std::vector<std::vector<std::size_t>> below(n), children(n);
  for (const auto& [i, j] : pairs) {
    const auto [low, high] = std::minmax(position_[at(i)], position_[at(j)]);
    below[low].push_back(high);
  }
  parent_.assign(n, none);
  row_start_.assign(1, 0);
  rows_.clear();
  std::vector<std::size_t> seen(n, n);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<std::size_t> rows;
    seen[j] = j;
    const auto add = [&](std::size_t row) {
      if (seen[row] == j) return;
      seen[row] = j;
      rows.push_back(row);
    };
    for (const std::size_t row : below[j]) add(row);
    for (const std::size_t child : children[j]) {
      for (std::size_t e = row_start_[child]; e < row_start_[child + 1]; ++e) add(rows_[e]);
    }
    std::sort(rows.begin(), rows.end());
    parent_[j] = rows.empty() ? none : rows.front();
    if (parent_[j] != none) children[parent_[j]].push_back(j);
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    row_start_.push_back(rows_.size());
  }
  above_.assign(n, 0);
  for (std::size_t j = n; j-- > 0;) {
    if (parent_[j] != none) above_[j] = above_[parent_[j]] + at(stride_[parent_[j]]);
  }
  std::vector<std::size_t> count(n + 1, 0);
  for (const std::size_t row : rows_) ++count[row + 1];
  for (std::size_t j = 0; j < n; ++j) count[j + 1] += count[j];
  update_start_ = count;
  updates_.resize(rows_.size());
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t e = row_start_[k]; e < row_start_[k + 1]; ++e) updates_[count[rows_[e]]++] = {k, e};
  }
}

void BlockCholesky::place_values() {
  const std::size_t n = size_.size();
  std::size_t value = 0, work = 0;
  column_value_.resize(n);
  work_start_.resize(n);
  row_value_.resize(rows_.size());
  for (std::size_t j = 0; j < n; ++j) {
    column_value_[j] = value;
    work_start_[j] = work;
    value += at(stride_[j] * size_[j]);
    work += at(stride_[j]);
    for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
      row_value_[e] = value;
      value += at(stride_[rows_[e]] * size_[j]);
    }
  }
  values_.assign(value, 0.0);
  const std::size_t largest = n == 0 ? 0 : at(*std::max_element(stride_.begin(), stride_.end()));
  solved_.assign(largest, 0.0);
  scale_.assign(largest, 0.0);
  work_.assign(work + row_padding, 0.0);  // the last numbers of a column are read as a whole register
  target_.assign(n, nullptr);
}

void BlockCholesky::load_column(std::size_t j) {
  const std::size_t end = j + 1 < size_.size() ? column_value_[j + 1] : values_.size();
  std::size_t filled = column_value_[j];
  const auto clear_up_to = [&](std::size_t place) {
    for (; filled < place; filled += row_padding) store(&values_[filled], Lanes{});
  };
  for (std::size_t k = source_start_[j]; k < source_start_[j + 1]; ++k) {
    const Source& source = sources_[k];
    clear_up_to(source.to);
    for (std::size_t v = 0; v < source.count; v += row_padding)
      store(&values_[source.to + v], load(&matrix_[source.from + v]));
    filled += source.count;
  }
  clear_up_to(end);
}

/// A_ij −= Σ_k L_ik L_jkᵀ for all rows i of column j.
template <int equal>
void BlockCholesky::update_column(std::size_t j) {
  target_[j] = &values_[column_value_[j]];
  for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) target_[rows_[e]] = &values_[row_value_[e]];
  for (std::size_t u = update_start_[j]; u < update_start_[j + 1]; ++u) {
    const auto [k, first] = updates_[u];
    const double* l_jk = &values_[row_value_[first]];
    for (std::size_t e = first; e < row_start_[k + 1]; ++e) {
      const std::size_t i = rows_[e];
      if constexpr (equal > 0) {
        subtract_block_product<equal>(&values_[row_value_[e]], l_jk, target_[i]);
      } else {
        subtract_block_product(stride_[i] / row_padding, size_[j], size_[k], &values_[row_value_[e]], l_jk,
                               stride_[j], target_[i]);
      }
    }
  }
}

template <int equal>
bool BlockCholesky::factor_columns() {
  for (std::size_t j = 0; j < size_.size(); ++j) {
    if (stale_[j] == 0) continue;
    // What is eliminated later depends on this column through its parent in the elimination tree.
    if (parent_[j] != none) stale_[parent_[j]] = 1;
    load_column(j);
    update_column<equal>(j);
    double* inverse = &values_[column_value_[j]];
    if constexpr (equal > 0) {
      if (!invert_factor<equal>(inverse)) return false;
    } else {
      if (!invert_factor(size<equal>(j), inverse, scale_.data())) return false;
    }
    for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
      double* x = &values_[row_value_[e]];
      if constexpr (equal > 0) {
        multiply_right<equal>(inverse, x);
      } else {
        multiply_right(stride<equal>(rows_[e]) / row_padding, size<equal>(j), inverse, x);
      }
    }
    stale_[j] = 0;
  }
  return true;
}

/// Calls what.template operator()<equal>().
template <typename Do>
void BlockCholesky::for_equal_size(const Do& what) const {
  if (equal_size_ == 6) {
    what.template operator()<6>();
  } else if (equal_size_ == 12) {
    what.template operator()<12>();
  } else {
    what.template operator()<0>();
  }
}

bool BlockCholesky::factor() {
  bool positive = false;
  for_equal_size([&]<int equal>() { positive = factor_columns<equal>(); });
  return positive;
}

/// y − Σ_i L_ijᵀ x_i for some unknowns of column j, from c on, into solved_. Returns their number.
template <int equal, int columns>
int BlockCholesky::gather(std::size_t j, int c) {
  Lanes t[columns]{};
  for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    const int rows = stride<equal>(i);
    add_lane_products(rows / row_padding, &values_[row_value_[e] + at(c * rows)], &work_[work_start_[i]], t);
  }
  const double* y = &work_[work_start_[j] + at(c)];
  double* out = &solved_[at(c)];
  if constexpr (columns == 1) {
    out[0] = y[0] - sum(t[0]);
  } else {
    store_first<columns>(out, stride<equal>(j) - c, load(y) - sums(t));
  }
  return columns;
}

/// L_jj⁻ᵀ y likewise.
template <int equal, int columns>
int BlockCholesky::divide(std::size_t j, int c) {
  Lanes t[columns]{};
  const int rows = stride<equal>(j);
  add_lane_products(rows / row_padding, &values_[column_value_[j] + at(c * rows)], solved_.data(), t);
  double* out = &work_[work_start_[j] + at(c)];
  if constexpr (columns == 1) {
    out[0] = sum(t[0]);
  } else {
    store_first<columns>(out, stride<equal>(j) - c, sums(t));
  }
  return columns;
}

/// Brings x into the order of elimination.
void BlockCholesky::take(std::span<const double> x) {
  for (std::size_t j = 0; j < size_.size(); ++j)
    std::copy_n(&x[offset_[j]], size_[j], &work_[work_start_[j]]);
}

void BlockCholesky::give(std::span<double> x) const {
  for (std::size_t j = 0; j < size_.size(); ++j)
    std::copy_n(&work_[work_start_[j]], size_[j], &x[offset_[j]]);
}

/// y ← L_jj⁻¹ y for column j, and what the rows i below, at of_row(i), lose by it.
template <int equal, typename OfRow>
void BlockCholesky::eliminate(std::size_t j, double* y, const OfRow& of_row) {
  const int size_j = size<equal>(j), rows = stride<equal>(j);
  multiply(rows / row_padding, size_j, &values_[column_value_[j]], y, solved_.data());
  for (int l = 0; l < rows; l += row_padding) store(y + l, load(&solved_[at(l)]));
  for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    subtract_times(stride<equal>(i) / row_padding, size_j, &values_[row_value_[e]], y, of_row(i));
  }
}

template <int equal>
void BlockCholesky::forward() {
  const auto of_row = [&](std::size_t i) { return &work_[work_start_[i]]; };
  for (std::size_t j = 0; j < size_.size(); ++j) {
    double* y = of_row(j);
    // Zero, as where a step has settled.
    if (std::all_of(y, y + size<equal>(j), [](double v) { return v == 0.0; })) continue;
    eliminate<equal>(j, y, of_row);
  }
}

template <int equal>
void BlockCholesky::backward() {
  std::fill(solved_.begin(), solved_.end(), 0.0);
  for (std::size_t j = size_.size(); j-- > 0;) {
    const int size_j = size<equal>(j);
    for (int c = 0; c < size_j;) c += size_j - c >= 6 ? gather<equal, 6>(j, c) : gather<equal, 1>(j, c);
    for (int c = 0; c < size_j;) c += size_j - c >= 6 ? divide<equal, 6>(j, c) : divide<equal, 1>(j, c);
  }
}

void BlockCholesky::solve(std::span<double> x, std::span<double> residual, const Excess& /*excess*/) {
  std::fill(residual.begin(), residual.end(), 0.0);
  take(x);
  for_equal_size([&]<int equal>() {
    forward<equal>();
    backward<equal>();
  });
  give(x);
}

template <int equal>
void BlockCholesky::half_forward(HalfSolution& half) {
  const auto of_row = [&](std::size_t i) { return &half.values[above_[i]]; };
  for (std::size_t j = at(half.column); j != none; j = parent_[j]) eliminate<equal>(j, of_row(j), of_row);
}

void BlockCholesky::half_solve(Part a, Part b, HalfSolution& half) {
  std::size_t first = none;
  for (const Part& part : {a, b}) {
    if (part.block >= 0) first = std::min(first, position_[at(part.block)]);
  }
  half.column = static_cast<int>(first);
  half.values.assign(above_[first] + at(stride_[first]), 0.0);
  for (const Part& part : {a, b}) {
    if (part.block >= 0)
      std::copy(part.values.begin(), part.values.end(), &half.values[above_[position_[at(part.block)]]]);
  }
  for_equal_size([&]<int equal>() { half_forward<equal>(half); });
}

double BlockCholesky::product(const HalfSolution& x, const HalfSolution& y) const {
  // The ways have all in common from where they meet.
  std::size_t i = at(x.column), j = at(y.column);
  while (i != j && i != none && j != none) (i < j ? i : j) = parent_[std::min(i, j)];
  if (i != j || i == none) return 0.0;
  Lanes t{};
  for (std::size_t k = 0; k < above_[i] + at(stride_[i]); k += row_padding)
    t = add_product(load(&x.values[k]), load(&y.values[k]), t);
  return sum(t);
}

double BlockCholesky::product(const HalfSolution& x, std::span<const double> y) const {
  Lanes t{};
  for (std::size_t j = at(x.column); j != none; j = parent_[j]) {
    for (std::size_t l = 0; l < at(stride_[j]); l += row_padding)
      t = add_product(load(&x.values[above_[j] + l]), load(&y[work_start_[j] + l]), t);
  }
  return sum(t);
}

void BlockCholesky::half_solve(std::span<const double> b, std::vector<double>& half) {
  take(b);
  for_equal_size([&]<int equal>() { forward<equal>(); });
  half = work_;
}

void BlockCholesky::finish(std::span<const double> half, std::span<const HalfSolution> halves,
                           std::span<const double> factor, std::span<double> x) {
  std::copy(half.begin(), half.end(), work_.begin());
  for (std::size_t k = 0; k < halves.size(); ++k) {
    for (std::size_t j = at(halves[k].column); j != none; j = parent_[j]) {
      double* y = &work_[work_start_[j]];
      for (int l = 0; l < stride_[j]; l += row_padding)
        store(y + l,
              add_product(broadcast(factor[k]), load(&halves[k].values[above_[j] + at(l)]), load(y + l)));
    }
  }
  for_equal_size([&]<int equal>() { backward<equal>(); });
  give(x);
}

}  // namespace

std::unique_ptr<BlockSolver> make_block_cholesky() {
  return std::make_unique<BlockCholesky>();
}

}  // namespace keyblock::linalg
