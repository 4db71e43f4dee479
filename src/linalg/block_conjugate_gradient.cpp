#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "linalg/block_kernels.h"
#include "linalg/block_solver.h"

namespace keyblock::linalg {

namespace {

constexpr int most_iterations = 400;

/// Blocks are scaled so that those on the diagonal are one: with A_jj = C_j C_jᵀ, the matrix is C (L + 1 + Lᵀ) Cᵀ with
/// L_ij = C_i⁻¹ A_ij C_j⁻ᵀ strictly below the diagonal. Preconditioned from both sides by (1 + L) it is
///
///     Â y = t + (1 + L)⁻¹ (y − t),     t = (1 + Lᵀ)⁻¹ y
///
/// L has single precision: it takes half the memory to read in every iteration, and the residual is that of the matrix itself.
/// Vectors are padded as the blocks are.
class BlockConjugateGradient final : public BlockSolver {
 public:
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override {
    std::fill(matrix_.begin(), matrix_.end(), 0.0);
    std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  }
  double* diagonal(int block) override { return &matrix_[diagonal_[at(block)]]; }
  BlockSlot slot(int pair) override { return slots_[at(pair)]; }
  void touch(int block) override { stale_[at(block)] = 1; }
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess) override;
  [[nodiscard]] bool is_iterative() const override { return true; }
  [[nodiscard]] bool solved() const override { return solved_; }

 private:
  using Vector = std::vector<double>;

  void divide_forward(Vector& v) const;
  void divide_backward(Vector& v) const;
  void apply(const Vector& y, Vector& out);
  void scale(std::span<const double> x, Vector& out) const;
  void unscale(const Vector& v, std::span<double> x);
  void subtract_product(std::span<const double> x, std::span<double> residual);
  static double dot(const Vector& a, const Vector& b);

  struct Entry {
    std::size_t row;     ///< > column
    std::size_t values;  ///< into matrix_
    std::size_t lower;   ///< into lower_
  };
  std::vector<int> size_, stride_;        ///< per block
  std::vector<std::size_t> offset_;       ///< per block: its unknowns in x
  std::vector<std::size_t> start_;        ///< per block, into padded vectors
  std::vector<std::size_t> entry_start_;  ///< per column, into entries_
  std::vector<Entry> entries_;
  std::vector<std::size_t> diagonal_;       ///< per block, into matrix_
  std::vector<std::size_t> inverse_start_;  ///< per block, into inverse_
  std::vector<BlockSlot> slots_;
  Vector matrix_;             ///< A
  Vector inverse_;            ///< C_j⁻¹
  std::vector<float> lower_;  ///< L
  std::vector<std::uint8_t> stale_;
  Vector scratch_;                   ///< of one block
  Vector t_, z_, r_, p_, q_, wide_;  ///< padded
  Vector correction_;                ///< of x
  bool solved_ = true;
};

void BlockConjugateGradient::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = sizes.size();
  size_.assign(sizes.begin(), sizes.end());
  stride_.clear();
  offset_.clear();
  start_.clear();
  std::size_t unknowns = 0, padded = 0, used = 0, lower = 0, inverse = 0;
  int largest = 0;
  for (const int size : sizes) {
    stride_.push_back(padded_rows(size));
    offset_.push_back(unknowns);
    start_.push_back(padded);
    unknowns += at(size);
    padded += at(padded_rows(size));
    largest = std::max(largest, padded_rows(size));
  }
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> below(n);  // row, pair
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [low, high] = std::minmax(pairs[k].first, pairs[k].second);
    below[at(low)].emplace_back(at(high), k);
  }
  diagonal_.clear();
  inverse_start_.clear();
  entries_.clear();
  entry_start_.assign(1, 0);
  std::vector<std::size_t> place(pairs.size());
  for (std::size_t j = 0; j < n; ++j) {
    diagonal_.push_back(used);
    inverse_start_.push_back(inverse);
    used += at(stride_[j] * size_[j]);
    inverse += at(stride_[j] * size_[j]);
    std::sort(below[j].begin(), below[j].end());
    for (const auto& [row, k] : below[j]) {
      entries_.push_back({row, used, lower});
      place[k] = used;
      used += at(stride_[row] * size_[j]);
      lower += at(stride_[row] * size_[j]);
    }
    entry_start_.push_back(entries_.size());
  }
  matrix_.assign(used, 0.0);
  inverse_.assign(inverse, 0.0);
  lower_.assign(lower, 0.0F);
  stale_.assign(n, 1);
  scratch_.assign(at(largest * largest), 0.0);
  for (Vector* v : {&t_, &z_, &r_, &p_, &q_, &wide_}) v->assign(padded, 0.0);
  slots_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [column, row] = std::minmax(pairs[k].first, pairs[k].second);
    slots_.push_back({&matrix_[place[k]], stride_[at(row)], row, column});
  }
}

bool BlockConjugateGradient::factor() {
  const std::size_t n = size_.size();
  for (std::size_t j = 0; j < n; ++j) {
    if (stale_[j] == 0) continue;
    double* inverse = &inverse_[inverse_start_[j]];
    std::copy_n(&matrix_[diagonal_[j]], stride_[j] * size_[j], inverse);
    if (!invert_factor(size_[j], inverse, scratch_.data())) return false;
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t e = entry_start_[j]; e < entry_start_[j + 1]; ++e) {
      const auto [i, values, lower] = entries_[e];
      if (stale_[i] == 0 && stale_[j] == 0) continue;
      // C_i⁻¹ A_ij, column by column, then from the right.
      const int rows = stride_[i];
      for (int c = 0; c < size_[j]; ++c) {
        multiply(rows / row_padding, size_[i], &inverse_[inverse_start_[i]], &matrix_[values + at(c * rows)],
                 &scratch_[at(c * rows)]);
      }
      multiply_right(rows / row_padding, size_[j], &inverse_[inverse_start_[j]], scratch_.data());
      for (std::size_t k = 0; k < at(rows * size_[j]); ++k)
        lower_[lower + k] = static_cast<float>(scratch_[k]);
    }
  }
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{0});
  return true;
}

/// v ← (1 + L)⁻¹ v.
void BlockConjugateGradient::divide_forward(Vector& v) const {
  for (std::size_t j = 0; j < size_.size(); ++j) {
    const double* x = &v[start_[j]];
    for (std::size_t e = entry_start_[j]; e < entry_start_[j + 1]; ++e) {
      const Entry& entry = entries_[e];
      const int lanes = stride_[entry.row] / row_padding;
      double* y = &v[start_[entry.row]];
      if (size_[j] == 6 && lanes == 1) {  // order 1: loops of known length
        subtract_times(1, 6, &lower_[entry.lower], x, y);
      } else {
        subtract_times(lanes, size_[j], &lower_[entry.lower], x, y);
      }
    }
  }
}

/// v ← (1 + Lᵀ)⁻¹ v.
void BlockConjugateGradient::divide_backward(Vector& v) const {
  const auto columns = [&]<int width>(std::size_t j, int c) {
    Lanes t[width]{};
    for (std::size_t e = entry_start_[j]; e < entry_start_[j + 1]; ++e) {
      const Entry& entry = entries_[e];
      const int rows = stride_[entry.row];
      add_lane_products(rows / row_padding, &lower_[entry.lower + at(c * rows)], &v[start_[entry.row]], t);
    }
    double* y = &v[start_[j] + at(c)];
    for (int k = 0; k < width; ++k) y[k] -= sum(t[k]);
    return width;
  };
  for (std::size_t j = size_.size(); j-- > 0;) {
    if (entry_start_[j] == entry_start_[j + 1]) continue;
    for (int c = 0; c < size_[j];)
      c += size_[j] - c >= 6 ? columns.template operator()<6>(j, c) : columns.template operator()<1>(j, c);
  }
}

void BlockConjugateGradient::apply(const Vector& y, Vector& out) {
  t_ = y;
  divide_backward(t_);
  for (std::size_t k = 0; k < y.size(); ++k) out[k] = y[k] - t_[k];
  divide_forward(out);
  for (std::size_t k = 0; k < y.size(); ++k) out[k] += t_[k];
}

/// out ← C⁻¹ x.
void BlockConjugateGradient::scale(std::span<const double> x, Vector& out) const {
  for (std::size_t j = 0; j < size_.size(); ++j) {
    multiply(stride_[j] / row_padding, size_[j], &inverse_[inverse_start_[j]], &x[offset_[j]],
             &out[start_[j]]);
  }
}

/// x ← C⁻ᵀ v.
void BlockConjugateGradient::unscale(const Vector& v, std::span<double> x) {
  for (std::size_t j = 0; j < size_.size(); ++j) {
    for (int c = 0; c < size_[j]; ++c) {
      Lanes t[1]{};
      add_lane_products(stride_[j] / row_padding, &inverse_[inverse_start_[j] + at(c * stride_[j])],
                        &v[start_[j]], t);
      x[offset_[j] + at(c)] = sum(t[0]);
    }
  }
}

/// residual −= A x.
void BlockConjugateGradient::subtract_product(std::span<const double> x, std::span<double> residual) {
  std::fill(wide_.begin(), wide_.end(), 0.0);
  for (std::size_t j = 0; j < size_.size(); ++j) {
    for (int c = 0; c < size_[j]; ++c) wide_[start_[j] + at(c)] = x[offset_[j] + at(c)];
  }
  std::fill(q_.begin(), q_.end(), 0.0);
  for (std::size_t j = 0; j < size_.size(); ++j) {
    const double* x_j = &wide_[start_[j]];
    double* y_j = &q_[start_[j]];
    const double* a = &matrix_[diagonal_[j]];
    for (int c = 0; c < size_[j]; ++c) {
      const double* column = a + c * stride_[j];
      double own = column[c] * x_j[c];
      for (int r = c + 1; r < size_[j]; ++r) {
        y_j[r] -= column[r] * x_j[c];
        own += column[r] * x_j[r];
      }
      y_j[c] -= own;
    }
    for (std::size_t e = entry_start_[j]; e < entry_start_[j + 1]; ++e) {
      const auto [i, values, lower] = entries_[e];
      subtract_times(stride_[i] / row_padding, size_[j], &matrix_[values], x_j, &q_[start_[i]]);
      for (int c = 0; c < size_[j]; ++c) {
        Lanes t[1]{};
        add_lane_products(stride_[i] / row_padding, &matrix_[values + at(c * stride_[i])], &wide_[start_[i]],
                          t);
        y_j[c] -= sum(t[0]);
      }
    }
  }
  for (std::size_t j = 0; j < size_.size(); ++j) {
    for (int c = 0; c < size_[j]; ++c) residual[offset_[j] + at(c)] += q_[start_[j] + at(c)];
  }
}

double BlockConjugateGradient::dot(const Vector& a, const Vector& b) {
  Lanes t{};
  for (std::size_t k = 0; k < a.size(); k += row_padding) t = add_product(load(&a[k]), load(&b[k]), t);
  return sum(t);
}

void BlockConjugateGradient::solve(std::span<double> x, std::span<double> residual, const Excess& excess) {
  std::copy(x.begin(), x.end(), residual.begin());
  std::fill(x.begin(), x.end(), 0.0);
  solved_ = true;
  correction_.resize(x.size());
  int iterations = 0;
  for (double too_large = excess(residual); too_large > 1.0; too_large = excess(residual)) {
    if (iterations >= most_iterations) {
      solved_ = false;
      return;
    }
    scale(residual, r_);
    divide_forward(r_);
    p_ = r_;
    std::fill(z_.begin(), z_.end(), 0.0);
    double rr = dot(r_, r_);
    // The residual of the scaled system tells when to look at that of the real one.
    const double drop = 0.5 / too_large, wanted = drop * drop * rr;
    while (rr > wanted && iterations < most_iterations) {
      ++iterations;
      apply(p_, q_);
      const double alpha = rr / dot(p_, q_);
      for (std::size_t k = 0; k < r_.size(); ++k) {
        z_[k] += alpha * p_[k];
        r_[k] -= alpha * q_[k];
      }
      const double next = dot(r_, r_), beta = next / rr;
      rr = next;
      for (std::size_t k = 0; k < p_.size(); ++k) p_[k] = r_[k] + beta * p_[k];
    }
    divide_backward(z_);
    unscale(z_, correction_);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += correction_[k];
    subtract_product(correction_, residual);
  }
}

}  // namespace

std::unique_ptr<BlockSolver> make_block_conjugate_gradient() {
  return std::make_unique<BlockConjugateGradient>();
}

}  // namespace keyblock::linalg
