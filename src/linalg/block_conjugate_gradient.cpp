#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "core/huge_pages.h"
#include "core/index.h"
#include "linalg/block_kernels.h"
#include "linalg/block_solver.h"
#include "linalg/partition.h"

namespace keyblock::linalg {

namespace {

constexpr int most_iterations = 400;
constexpr double well_enough =
    0.9;  // excess of the iteration's residual, with which that of the matrix is small enough

/// Blocks are scaled so that those on the diagonal are one: with A_jj = C_j C_jᵀ, the matrix is C (L + 1 + Lᵀ) Cᵀ with
/// L_ij = C_i⁻¹ A_ij C_j⁻ᵀ strictly below the diagonal. Preconditioned from both sides by (1 + L) it is
///
///     Â y = t + (1 + L)⁻¹ (y − t),     t = (1 + Lᵀ)⁻¹ y
///
/// L and the vectors have single precision: half the memory to read in every iteration, and half the instructions. A few digits of
/// the solution are found so; the residual is then that of the matrix itself, and asks for more where they do not do.
/// Vectors are padded as the blocks are. In the order of `partition`, the parts are solved for at the same time, by as many threads
/// as there are; sums go part by part.
class BlockConjugateGradient final : public BlockSolver {
 public:
  explicit BlockConjugateGradient(ThreadTeam* team) : team_(team) {}
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override {
    std::fill(matrix_.begin(), matrix_.end(), 0.0);
    std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  }
  double* diagonal(int block) override { return &matrix_[diagonal_[place_[at(block)]]]; }
  BlockSlot slot(int pair) override { return slots_[at(pair)]; }
  void touch(int block) override { stale_[place_[at(block)]] = 1; }
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess) override;
  [[nodiscard]] bool is_iterative() const override { return true; }
  [[nodiscard]] bool solved() const override { return solved_; }

 private:
  using Vector = HugePageVector<float>;
  using WideVector = HugePageVector<double>;
  struct Range {
    std::size_t first, last;  ///< places
  };

  void place_vectors(std::span<const int> sizes, std::span<const int> order);
  std::vector<std::size_t> place_matrix(std::span<const std::pair<int, int>> pairs);
  template <typename Body>
  void for_parts(const Body& body) const;
  template <typename Body>
  void for_ranges(const Body& body) const;
  template <typename Body>
  double sum_over_ranges(const Body& body);
  [[nodiscard]] Range between() const { return {begin_[begin_.size() - 2], begin_.back()}; }
  template <auto place, typename Number>
  void subtract_lower(const Number* values, const Number* x, Number* y, Range range) const;
  template <auto place, typename Number>
  void subtract_lower_between(const Number* values, const Number* x, Number* y) const;
  template <auto place, typename Number>
  void subtract_upper(const Number* values, const Number* x, Number* y, Range range) const;
  void divide_forward(Vector& v) const;
  void backward(Vector& v, Range range) const;
  void divide_backward(Vector& v) const;
  template <typename Body>
  void padded(Range range, const Body& body) const;
  double apply(double beta);
  double go(double alpha);
  void scale(std::span<const double> x);
  void unscale(std::size_t j, const Vector& v, double* x);
  void find_residual(std::span<double> residual);
  void take_over(const Vector& v, std::span<double> x, std::span<double> residual);
  int iterate(double too_large, const Excess& excess, int most);

  struct Entry {
    std::uint32_t row;     ///< > column
    std::uint32_t values;  ///< into matrix_
    std::uint32_t lower;   ///< into lower_
  };
  // Everything is by place in the order of the partition, but for the slots.
  ThreadTeam* team_;
  std::vector<std::size_t> place_;  ///< block → place
  std::vector<std::size_t> begin_;  ///< Partition::begin
  std::vector<int> size_, stride_;
  std::vector<std::size_t> offset_;       ///< its unknowns in x
  std::vector<std::size_t> start_;        ///< into padded vectors
  std::vector<std::size_t> entry_start_;  ///< per column, into entries_
  std::vector<std::size_t>
      between_start_;  ///< per column, likewise: the first whose row lies between the parts
  std::vector<Entry> entries_;
  struct RowEntry {
    std::size_t column, entry;
  };
  std::vector<std::size_t> row_start_;      ///< per block between the parts, into row_entries_
  std::vector<RowEntry> row_entries_;       ///< of a row, by columns
  std::vector<std::size_t> diagonal_;       ///< into matrix_
  std::vector<std::size_t> inverse_start_;  ///< into inverse_
  std::vector<BlockSlot> slots_;
  WideVector matrix_;            ///< A
  WideVector inverse_;           ///< C_j⁻¹
  HugePageVector<float> lower_;  ///< L
  std::vector<std::uint8_t> stale_;
  int largest_ = 0;               ///< stride of a block
  Vector t_, z_, r_, p_, q_;      ///< padded
  WideVector wide_, product_;     ///< padded: scratch
  std::vector<double> estimate_;  ///< of the residual
  std::vector<double> sums_;      ///< per range
  bool solved_ = true;
};

/// Of every part, and then of the blocks between them; parts may go at the same time.
template <typename Body>
void BlockConjugateGradient::for_parts(const Body& body) const {
  const std::size_t count = begin_.size() - 2;
  const auto some = [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) body(k, Range{begin_[k], begin_[k + 1]});
  };
  if (team_ == nullptr || count == 1) {
    some(0, count);
  } else {
    team_->for_range(count, 2, some);
  }
}

/// Of the blocks between the parts, and of every part.
template <typename Body>
void BlockConjugateGradient::for_ranges(const Body& body) const {
  body(between());
  for_parts([&](std::size_t, Range range) { body(range); });
}

/// Σ over parts and what lies between, in that order.
template <typename Body>
double BlockConjugateGradient::sum_over_ranges(const Body& body) {
  for_parts([&](std::size_t k, Range range) { sums_[k] = body(range); });
  sums_.back() = body(between());
  double total = 0.0;
  for (const double part : sums_) total += part;
  return total;
}

/// Of every register of a padded vector that belongs to a range.
template <typename Body>
void BlockConjugateGradient::padded(Range range, const Body& body) const {
  const auto start = [&](std::size_t place) { return place < start_.size() ? start_[place] : p_.size(); };
  for (std::size_t k = start(range.first); k < start(range.last); k += row_padding) body(k);
}

void BlockConjugateGradient::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  Partition found = partition(sizes.size(), pairs);
  begin_ = std::move(found.begin);
  sums_.assign(begin_.size() - 1, 0.0);
  place_.resize(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) place_[at(found.order[k])] = k;
  place_vectors(sizes, found.order);
  const std::vector<std::size_t> values = place_matrix(pairs);
  slots_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const bool i_below = place_[at(i)] > place_[at(j)];
    slots_.push_back(
        {&matrix_[values[k]], padded_rows(sizes[at(i_below ? i : j)]), i_below ? i : j, i_below ? j : i});
  }
}

void BlockConjugateGradient::place_vectors(std::span<const int> sizes, std::span<const int> order) {
  std::vector<std::size_t> unknown(sizes.size() + 1, 0);
  for (std::size_t b = 0; b < sizes.size(); ++b) unknown[b + 1] = unknown[b] + at(sizes[b]);
  size_.clear();
  stride_.clear();
  offset_.clear();
  start_.clear();
  largest_ = 0;
  std::size_t padded = 0;
  for (const int block : order) {
    const int size = sizes[at(block)];
    size_.push_back(size);
    stride_.push_back(padded_rows(size));
    offset_.push_back(unknown[at(block)]);
    start_.push_back(padded);
    padded += at(padded_rows(size));
    largest_ = std::max(largest_, padded_rows(size));
  }
  for (Vector* v : {&t_, &z_, &r_, &p_, &q_}) v->assign(padded, 0.0F);
  for (WideVector* v : {&wide_, &product_}) v->assign(padded, 0.0);
}

/// Where the block of every pair is in matrix_.
std::vector<std::size_t> BlockConjugateGradient::place_matrix(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = size_.size(), first_between = between().first;
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> below(n);  // row, pair
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [low, high] = std::minmax(place_[at(pairs[k].first)], place_[at(pairs[k].second)]);
    below[low].emplace_back(high, k);
  }
  diagonal_.clear();
  inverse_start_.clear();
  entries_.clear();
  entry_start_.assign(1, 0);
  between_start_.clear();
  std::vector<std::size_t> values(pairs.size());
  std::vector<std::vector<RowEntry>> rows(n - first_between);
  std::size_t used = 0, lower = 0, inverse = 0;
  for (std::size_t j = 0; j < n; ++j) {
    diagonal_.push_back(used);
    inverse_start_.push_back(inverse);
    used += at(stride_[j] * size_[j]);
    inverse += at(stride_[j] * size_[j]);
    std::sort(below[j].begin(), below[j].end());
    between_start_.push_back(entries_.size());
    for (const auto& [row, k] : below[j]) {
      entries_.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(used),
                          static_cast<std::uint32_t>(lower)});
      if (row < first_between) {
        between_start_[j] = entries_.size();
      } else {
        rows[row - first_between].push_back({j, entries_.size() - 1});
      }
      values[k] = used;
      used += at(stride_[row] * size_[j]);
      lower += at(stride_[row] * size_[j]);
    }
    entry_start_.push_back(entries_.size());
  }
  row_start_.assign(1, 0);
  row_entries_.clear();
  for (const auto& row : rows) {
    row_entries_.insert(row_entries_.end(), row.begin(), row.end());
    row_start_.push_back(row_entries_.size());
  }
  if (used > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("a matrix of more than four thousand million numbers");
  matrix_.assign(used, 0.0);
  inverse_.assign(inverse, 0.0);
  lower_.assign(lower, 0.0F);
  stale_.assign(n, 1);
  return values;
}

bool BlockConjugateGradient::factor() {
  std::vector<std::uint8_t> good(begin_.size() - 1, 1);
  const auto invert = [&](std::size_t k, Range range) {
    WideVector scratch(at(largest_));
    for (std::size_t j = range.first; j < range.last && good[k] != 0; ++j) {
      if (stale_[j] == 0) continue;
      double* diagonal = &matrix_[diagonal_[j]];
      for (int c = 1; c < size_[j]; ++c) {
        for (int r = 0; r < c; ++r) diagonal[c * stride_[j] + r] = diagonal[r * stride_[j] + c];
      }
      double* inverse = &inverse_[inverse_start_[j]];
      std::copy_n(diagonal, stride_[j] * size_[j], inverse);
      good[k] = size_[j] == 6 ? invert_factor<6>(inverse) : invert_factor(size_[j], inverse, scratch.data());
    }
  };
  for_parts(invert);
  invert(good.size() - 1, between());
  if (std::find(good.begin(), good.end(), 0) != good.end()) return false;
  const auto divide = [&](std::size_t, Range range) {
    WideVector scratch(at(largest_ * largest_));
    for (std::size_t j = range.first; j < range.last; ++j) {
      for (std::size_t e = entry_start_[j]; e < entry_start_[j + 1]; ++e) {
        const auto [i, values, lower] = entries_[e];
        if (stale_[i] == 0 && stale_[j] == 0) continue;
        // C_i⁻¹ A_ij, column by column, then from the right.
        const int rows = stride_[i];
        for (int c = 0; c < size_[j]; ++c) {
          multiply(rows / row_padding, size_[i], &inverse_[inverse_start_[i]],
                   &matrix_[values + at(c * rows)], &scratch[at(c * rows)]);
        }
        multiply_right(rows / row_padding, size_[j], &inverse_[inverse_start_[j]], scratch.data());
        for (std::size_t k = 0; k < at(rows * size_[j]); ++k)
          lower_[lower + k] = static_cast<float>(scratch[k]);
      }
    }
  };
  for_parts(divide);
  divide(0, between());
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{0});
  return true;
}

/// y −= S x with S the blocks strictly below the diagonal, of L or of A; only what the columns of a part add to its own rows.
template <auto place, typename Number>
void BlockConjugateGradient::subtract_lower(const Number* values, const Number* x, Number* y,
                                            Range range) const {
  for (std::size_t j = range.first; j < range.last; ++j) {
    for (std::size_t e = entry_start_[j]; e < between_start_[j]; ++e) {
      const Entry& entry = entries_[e];
      const int lanes = stride_[entry.row] / row_padding;
      const Number *block = values + entry.*place, *x_j = x + start_[j];
      Number* y_i = y + start_[entry.row];
      if (size_[j] == 6 && lanes == 1) {  // order 1: loops of known length
        subtract_times(1, 6, block, x_j, y_i);
      } else {
        subtract_times(lanes, size_[j], block, x_j, y_i);
      }
    }
  }
}

/// The same for rows between the parts, which gather, so that no two parts write to them.
template <auto place, typename Number>
void BlockConjugateGradient::subtract_lower_between(const Number* values, const Number* x, Number* y) const {
  const std::size_t first = between().first;
  for (std::size_t i = first; i < size_.size(); ++i) {
    for (std::size_t k = row_start_[i - first]; k < row_start_[i - first + 1]; ++k) {
      const auto [j, entry] = row_entries_[k];
      subtract_times(stride_[i] / row_padding, size_[j], values + entries_[entry].*place, x + start_[j],
                     y + start_[i]);
    }
  }
}

/// y −= Sᵀ x, for the rows of a part from the last to the first.
template <auto place, typename Number>
void BlockConjugateGradient::subtract_upper(const Number* values, const Number* x, Number* y,
                                            Range range) const {
  using Register = decltype(load(x));
  const auto columns = [&]<int width>(std::size_t j, int c) {
    Register t[width]{};
    for (std::size_t e = entry_start_[j]; e < entry_start_[j + 1]; ++e) {
      const Entry& entry = entries_[e];
      const int rows = stride_[entry.row];
      const Number *block = values + entry.*place + at(c * rows), *x_i = x + start_[entry.row];
      if (rows == row_padding) {
        add_lane_products(1, block, x_i, t);
      } else {
        add_lane_products(rows / row_padding, block, x_i, t);
      }
    }
    Number* y_j = y + start_[j] + at(c);
    if (width == 6 && size_[j] == 6) {
      store(y_j, load(y_j) - sums(t));
    } else {
      for (int k = 0; k < width; ++k) y_j[k] -= sum(t[k]);
    }
    return width;
  };
  for (std::size_t j = range.last; j-- > range.first;) {
    if (entry_start_[j] == entry_start_[j + 1]) continue;
    for (int c = 0; c < size_[j];)
      c += size_[j] - c >= 6 ? columns.template operator()<6>(j, c) : columns.template operator()<1>(j, c);
  }
}

/// v ← (1 + L)⁻¹ v.
void BlockConjugateGradient::divide_forward(Vector& v) const {
  for_parts([&](std::size_t, Range range) {
    subtract_lower<&Entry::lower>(lower_.data(), v.data(), v.data(), range);
  });
  subtract_lower_between<&Entry::lower>(lower_.data(), v.data(), v.data());
}

void BlockConjugateGradient::backward(Vector& v, Range range) const {
  subtract_upper<&Entry::lower>(lower_.data(), v.data(), v.data(), range);
}

/// v ← (1 + Lᵀ)⁻¹ v.
void BlockConjugateGradient::divide_backward(Vector& v) const {
  backward(v, between());
  for_parts([&](std::size_t, Range range) { backward(v, range); });
}

/// p ← r + β p and q ← Â p. Returns p · q.
double BlockConjugateGradient::apply(double beta) {
  const auto before = [&](std::size_t, Range range) {
    const NarrowLanes b = broadcast(static_cast<float>(beta));
    padded(range, [&](std::size_t k) {
      const NarrowLanes p = load(&r_[k]) + b * load(&p_[k]);
      store(&p_[k], p);
      store(&t_[k], p);
    });
    backward(t_, range);
    padded(range, [&](std::size_t k) { store(&q_[k], load(&p_[k]) - load(&t_[k])); });
  };
  before(0, between());
  for_parts(before);
  divide_forward(q_);
  return sum_over_ranges([&](Range range) {
    Lanes total{};
    padded(range, [&](std::size_t k) {
      const NarrowLanes q = load(&q_[k]) + load(&t_[k]);
      store(&q_[k], q);
      total = add_product(widen(load(&p_[k])), widen(q), total);
    });
    return sum(total);
  });
}

/// z ← z + α p and r ← r − α q. Returns r · r.
double BlockConjugateGradient::go(double alpha) {
  const NarrowLanes a = broadcast(static_cast<float>(alpha));
  return sum_over_ranges([&](Range range) {
    Lanes total{};
    padded(range, [&](std::size_t k) {
      store(&z_[k], load(&z_[k]) + a * load(&p_[k]));
      const NarrowLanes r = load(&r_[k]) - a * load(&q_[k]);
      store(&r_[k], r);
      total = add_product(widen(r), widen(r), total);
    });
    return sum(total);
  });
}

/// r ← C⁻¹ x
void BlockConjugateGradient::scale(std::span<const double> x) {
  for_ranges([&](Range range) {
    for (std::size_t j = range.first; j < range.last; ++j) {
      double* scaled = &wide_[start_[j]];
      multiply(stride_[j] / row_padding, size_[j], &inverse_[inverse_start_[j]], &x[offset_[j]], scaled);
      for (int l = 0; l < stride_[j]; l += row_padding)
        store(&r_[start_[j] + at(l)], narrow(load(scaled + l)));
    }
  });
}

/// x ← C_j⁻ᵀ v_j, padded.
void BlockConjugateGradient::unscale(std::size_t j, const Vector& v, double* x) {
  double* wide = &wide_[start_[j]];
  const double* inverse = &inverse_[inverse_start_[j]];
  for (int l = 0; l < stride_[j]; l += row_padding) store(wide + l, widen(load(&v[start_[j] + at(l)])));
  if (size_[j] == 6) {
    Lanes t[6]{};
    add_lane_products(1, inverse, wide, t);
    store(x, sums(t));
    return;
  }
  for (int c = 0; c < size_[j]; ++c) {
    Lanes t[1]{};
    add_lane_products(stride_[j] / row_padding, inverse + c * stride_[j], wide, t);
    x[c] = sum(t[0]);
  }
}

/// What x lacks of the solution, as the iteration has it: C (1 + L) r. It is that of the matrix but for what single precision
/// leaves.
void BlockConjugateGradient::find_residual(std::span<double> residual) {
  for_ranges([&](Range range) { padded(range, [&](std::size_t k) { store(&q_[k], -load(&r_[k])); }); });
  for_parts([&](std::size_t, Range range) {
    subtract_lower<&Entry::lower>(lower_.data(), r_.data(), q_.data(), range);
  });
  subtract_lower_between<&Entry::lower>(lower_.data(), r_.data(), q_.data());
  // C v = A_jj C⁻ᵀ v
  for_ranges([&](Range range) {
    for (std::size_t j = range.first; j < range.last; ++j) {
      double *unscaled = &product_[start_[j]], *product = &wide_[start_[j]];
      unscale(j, q_, unscaled);
      multiply(stride_[j] / row_padding, size_[j], &matrix_[diagonal_[j]], unscaled, product);
      for (int c = 0; c < size_[j]; ++c) residual[offset_[j] + at(c)] = -product[c];
    }
  });
}

/// x += C⁻ᵀ v, and residual −= A C⁻ᵀ v.
void BlockConjugateGradient::take_over(const Vector& v, std::span<double> x, std::span<double> residual) {
  for_ranges([&](Range range) {
    for (std::size_t j = range.first; j < range.last; ++j) {
      double* correction = &product_[start_[j]];
      unscale(j, v, correction);
      for (int c = 0; c < size_[j]; ++c) x[offset_[j] + at(c)] += correction[c];
    }
  });
  std::swap(wide_, product_);
  const double* correction = wide_.data();
  const auto multiply_rows = [&](Range range) {
    for (std::size_t j = range.first; j < range.last; ++j) {
      multiply(stride_[j] / row_padding, size_[j], &matrix_[diagonal_[j]], correction + start_[j],
               &product_[start_[j]]);
      for (int l = 0; l < stride_[j]; l += row_padding) {
        double* of_block = &product_[start_[j] + at(l)];
        store(of_block, -load(of_block));
      }
    }
    subtract_upper<&Entry::values>(matrix_.data(), correction, product_.data(), range);
  };
  for_ranges(multiply_rows);
  for_parts([&](std::size_t, Range range) {
    subtract_lower<&Entry::values>(matrix_.data(), correction, product_.data(), range);
  });
  subtract_lower_between<&Entry::values>(matrix_.data(), correction, product_.data());
  for_ranges([&](Range range) {
    for (std::size_t j = range.first; j < range.last; ++j) {
      for (int c = 0; c < size_[j]; ++c) residual[offset_[j] + at(c)] += product_[start_[j] + at(c)];
    }
  });
}

/// Conjugate gradients from r_ on, to z_. Returns how many iterations that took.
///
/// When it is enough, the residual itself has to say: its norm in the scaled system differs from the largest of its numbers by a
/// factor of ten and more, the one way or the other. As it costs most of an iteration it is looked at when it should be small
/// enough, going by how far it was away the last time; the first time, three quarters of the digits on the way.
int BlockConjugateGradient::iterate(double too_large, const Excess& excess, int most) {
  std::fill(p_.begin(), p_.end(), 0.0F);
  std::fill(z_.begin(), z_.end(), 0.0F);
  double rr = go(0.0), beta = 0.0, wanted = rr / (too_large * std::sqrt(too_large));
  for (int iterations = 1;; ++iterations) {
    const double next = go(rr / apply(beta));
    beta = next / rr;
    rr = next;
    if (iterations == most) return most;
    if (rr > wanted) continue;
    find_residual(estimate_);
    too_large = excess(estimate_);
    if (too_large <= well_enough) return iterations;
    wanted = 0.5 * rr / (too_large * too_large);
  }
}

void BlockConjugateGradient::solve(std::span<double> x, std::span<double> residual, const Excess& excess) {
  std::copy(x.begin(), x.end(), residual.begin());
  std::fill(x.begin(), x.end(), 0.0);
  solved_ = true;
  estimate_.resize(x.size());
  int iterations = 0;
  for (double too_large = excess(residual); too_large > 1.0; too_large = excess(residual)) {
    if (iterations >= most_iterations) {
      solved_ = false;
      return;
    }
    scale(residual);
    divide_forward(r_);
    iterations += iterate(too_large, excess, most_iterations - iterations);
    divide_backward(z_);
    take_over(z_, x, residual);
  }
}

}  // namespace

std::unique_ptr<BlockSolver> make_block_conjugate_gradient(ThreadTeam* team) {
  return std::make_unique<BlockConjugateGradient>(team);
}

}  // namespace keyblock::linalg
