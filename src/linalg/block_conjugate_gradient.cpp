#include "linalg/block_conjugate_gradient.h"

#include <algorithm>
#include <cmath>

#include "linalg/block_kernels.h"

namespace keyblock::linalg {

namespace {

constexpr int most_iterations = 400;
// Excess of the iteration's residual, with which that of the matrix is small enough.
constexpr double well_enough = 0.9;

}  // namespace

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

void BlockConjugateGradient::clear() {
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  // Each diagonal block is followed by those below it, and these by the next diagonal block.
  const auto start = [&](std::size_t place) {
    return matrix_.data() + (place < diagonal_.size() ? diagonal_[place] : matrix_.size());
  };
  for_ranges([&](Range range) { std::fill(start(range.first), start(range.last), 0.0); });
}

/// C_i⁻¹ A C_j⁻ᵀ
void BlockConjugateGradient::scale_block(std::size_t i, std::size_t j, const double* a,
                                         double* scaled) const {
  const double *left = &inverse_[inverse_start_[i]], *right = &inverse_[inverse_start_[j]];
  const auto multiply_left = [&](int lanes, int rows, int columns) {
    for (int c = 0; c < columns; ++c) {
      const int first = c * lanes * row_padding;
      multiply(lanes, rows, left, a + first, scaled + first);
    }
  };
  if (size_[i] == 6 && size_[j] == 6) {
    multiply_left(1, 6, 6);
    multiply_right<6>(right, scaled);
  } else {
    multiply_left(stride_[i] / row_padding, size_[i], size_[j]);
    multiply_right(stride_[i] / row_padding, size_[j], right, scaled);
  }
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
        scale_block(i, j, &matrix_[values], scratch.data());
        for (std::size_t k = 0; k < at(stride_[i] * size_[j]); k += row_padding)
          store(&lower_[lower + k], narrow(load(&scratch[k])));
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

/// The same for rows between the parts, which gather, so that no two parts write to them: from the columns of the parts each on its
/// own, and then from each other in their order.
template <auto place, typename Number>
void BlockConjugateGradient::subtract_lower_between(const Number* values, const Number* x, Number* y) const {
  constexpr std::size_t worth_threads = 64;  // rows
  const std::size_t first = between().first, rows = size_.size() - first;
  const auto subtract = [&](std::size_t row, std::size_t begin, std::size_t end) {
    const std::size_t i = first + row;
    for (std::size_t k = begin; k < end; ++k) {
      const auto [j, entry] = row_entries_[k];
      subtract_times(stride_[i] / row_padding, size_[j], values + entries_[entry].*place, x + start_[j],
                     y + start_[i]);
    }
  };
  const auto gather = [&](std::size_t from, std::size_t to) {
    for (std::size_t row = from; row < to; ++row) subtract(row, row_start_[row], row_between_[row]);
  };
  if (team_ == nullptr) {
    gather(0, rows);
  } else {
    team_->for_range(rows, worth_threads, gather);
  }
  for (std::size_t row = 0; row < rows; ++row) subtract(row, row_between_[row], row_start_[row + 1]);
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

std::unique_ptr<BlockSolver> make_block_conjugate_gradient(ThreadTeam* team) {
  return std::make_unique<BlockConjugateGradient>(team);
}

}  // namespace keyblock::linalg
