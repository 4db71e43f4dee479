// What the iteration of conjugate residuals is made of: passes over the blocks of the matrix and their vectors.
#include <type_traits>

#include "linalg/block_conjugate_residual.h"
#include "linalg/block_kernels.h"
#include "linalg/paired_columns.h"

namespace keyblock::linalg {

namespace {

/// Sizes of blocks and where they are in padded vectors.
struct AnyBlocks {
  const int *sizes, *strides;
  const std::size_t* starts;
  [[nodiscard]] int size(std::size_t j) const { return sizes[j]; }
  [[nodiscard]] int stride(std::size_t j) const { return strides[j]; }
  [[nodiscard]] std::size_t start(std::size_t j) const { return starts[j]; }
};

/// The same where all blocks are of order 1: known to the compiler.
struct BlocksOfOrder1 {
  static constexpr int size(std::size_t /*j*/) { return 6; }
  static constexpr int stride(std::size_t /*j*/) { return padded_rows(6); }
  static constexpr std::size_t start(std::size_t j) { return j * padded_rows(6); }
};

/// Calls body(k) for each register of block j.
template <typename Layout, typename Body>
void for_registers(Layout layout, std::size_t j, const Body& body) {
  for (int l = 0; l < layout.stride(j); l += row_padding) body(layout.start(j) + at(l));
}

}  // namespace

template <typename Body>
decltype(auto) BlockConjugateResidual::with_layout(const Body& body) const {
  if (same_) return body(BlocksOfOrder1{});
  return body(AnyBlocks{size_.data(), stride_.data(), start_.data()});
}

/// y −= S_j x_j of the rows of the same range, with S_j what stands above the diagonal in column j of A, from `block` on.
template <typename Layout, typename Number>
void BlockConjugateResidual::subtract_above(Layout layout, std::size_t j, const Number* block,
                                            const Number* x, Number* y) const {
  const Number* x_j = x + layout.start(j);
  for (std::size_t e = column_start_[j]; e < own_start_[j]; ++e)
    block += layout.stride(rows_[e]) * layout.size(j);
  for (std::size_t e = own_start_[j]; e < column_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    subtract_times(layout.stride(i) / row_padding, layout.size(j), block, x_j, y + layout.start(i));
    block += layout.stride(i) * layout.size(j);
  }
}

/// The same with U.
template <typename Layout>
void BlockConjugateResidual::subtract_scaled(Layout layout, std::size_t j, const float* x, float* y) const {
  if constexpr (std::is_same_v<Layout, BlocksOfOrder1>) {
    const float* block = &above_[std::size_t{own_start_[j]} * paired_columns::block_size];
    const paired_columns::Factors factors(load(x + layout.start(j)));
    for (std::size_t e = own_start_[j]; e < column_start_[j + 1]; ++e, block += paired_columns::block_size) {
      float* y_i = y + layout.start(rows_[e]);
      store(y_i, load(y_i) - factors.product(block));
    }
  } else {
    subtract_above(layout, j, &above_[above_start_[j]], x, y);
  }
}

/// y −= S x of the rows between the parts, with S the blocks whose columns lie in parts; subtract(entry, row) does it for one. Rows
/// gather, so that no two parts write to them.
template <typename Subtract>
void BlockConjugateResidual::for_entries_between(const Subtract& subtract) const {
  for_rows_between([&](std::size_t row) { for_entries(row, subtract); });
}
template <typename Subtract>
void BlockConjugateResidual::for_entries(std::size_t row, const Subtract& subtract) const {
  for (std::size_t k = row_start_[row]; k < row_start_[row + 1]; ++k) {
    if (!is_near_ || near_.has[row_entries_[k].column] == 1) subtract(row_entries_[k], row);
  }
}

/// y −= U x of the rows between the parts, of columns in parts.
template <typename Layout>
void BlockConjugateResidual::subtract_scaled_of_parts(Layout layout, const float* x, float* y) const {
  for_entries_between([&](const RowEntry& entry, std::size_t row) {
    const float *block = &above_by_rows_[entry.copy], *x_j = x + layout.start(entry.column);
    float* y_i = y + layout.start(row);
    if constexpr (std::is_same_v<Layout, BlocksOfOrder1>) {
      store(y_i, load(y_i) - paired_columns::Factors(load(x_j)).product(block));
    } else {
      subtract_times(layout.stride(row) / row_padding, layout.size(entry.column), block, x_j, y_i);
    }
  });
}

/// y_j ← (Uᵀ x)_j.
template <typename Layout>
void BlockConjugateResidual::store_transposed(Layout layout, std::size_t j, const float* x, float* y) const {
  if constexpr (std::is_same_v<Layout, BlocksOfOrder1>) {
    const float* block = &above_[std::size_t{column_start_[j]} * paired_columns::block_size];
    paired_columns::RowProducts products;
    for (std::size_t e = column_start_[j]; e < column_start_[j + 1]; ++e, block += paired_columns::block_size)
      products.add(block, paired_columns::Rows(load(x + layout.start(rows_[e]))));
    store(y + layout.start(j), products.sums());
  } else {
    in_sixes(layout.size(j), [&]<int width>(int c) {
      NarrowLanes t[width]{};
      const float* values = &above_[above_start_[j]];
      for (std::size_t e = column_start_[j]; e < column_start_[j + 1]; ++e) {
        const std::size_t i = rows_[e];
        add_lane_products(layout.stride(i) / row_padding, values + c * layout.stride(i), x + layout.start(i),
                          t);
        values += layout.stride(i) * layout.size(j);
      }
      store_first<width>(y + layout.start(j) + at(c), layout.stride(j) - c, sums(t));
    });
  }
}

/// The step of the last iteration, of one register, Â r being in t_. Returns r after it.
template <BlockConjugateResidual::Vectors vectors>
inline NarrowLanes BlockConjugateResidual::advance(const Ways& ways, std::size_t k) {
  const Way& last = ways.last;
  const NarrowLanes alpha = broadcast(last.alpha), beta = broadcast(last.beta), gamma = broadcast(last.gamma),
                    r = load(&r_[k]), last_s = load(&s_[k]), s = gamma * load(&t_[k]) + beta * last_s,
                    after = r - alpha * s;
  if constexpr (vectors != Vectors::r_and_s) {
    NarrowLanes p = load(&p_[k]), z = load(&z_[k]);
    if constexpr (vectors == Vectors::all_by_two) {
      const NarrowLanes last_alpha = broadcast(ways.before.alpha), last_r = r + last_alpha * last_s;
      p = last_r + broadcast(ways.before.beta) * p;
      z += last_alpha * p;
    }
    p = gamma * r + beta * p;
    store(&p_[k], p);
    store(&z_[k], z + alpha * p);
  }
  store(&s_[k], s);
  store(&r_[k], after);
  return after;
}

/// The step of the last iteration; then t ← (1 + Uᵀ)⁻¹ r and q ← r − t, of some places. No calls within: they would keep vectors from
/// staying in registers.
template <BlockConjugateResidual::Vectors vectors, typename Layout, typename Some>
[[gnu::flatten]] void BlockConjugateResidual::go_forward(Layout layout, Some places, const Ways& ways) {
  for_each(places, [&](std::size_t j) {
    store_transposed(layout, j, t_.data(), q_.data());
    for_registers(layout, j, [&](std::size_t k) { store(&t_[k], advance<vectors>(ways, k) - load(&q_[k])); });
  });
}

/// q ← (1 + U)⁻¹ q and t ← t + q, which is Â r, of some places, but for what columns elsewhere add to their rows.
template <typename Layout, typename Some>
[[gnu::flatten]] BlockConjugateResidual::Dots BlockConjugateResidual::go_backward(Layout layout,
                                                                                  Some places) {
  Lanes rr{}, rq{}, qq{};
  for_each_backward(places, [&](std::size_t j) {
    subtract_scaled(layout, j, q_.data(), q_.data());
    for_registers(layout, j, [&](std::size_t k) {
      const NarrowLanes t = load(&t_[k]) + load(&q_[k]);
      store(&t_[k], t);
      const Lanes q = widen(t), r = widen(load(&r_[k]));
      rr = add_product(r, r, rr);
      rq = add_product(r, q, rq);
      qq = add_product(q, q, qq);
    });
  });
  return {sum(rr), sum(rq), sum(qq)};
}

/// Once through all that is solved: forward(places), then backward(k, places) of each part while a cache has it, and of what lies between
/// them, which comes first forward and last backward: when y −= U x has been done for the columns of the parts.
template <typename Layout, typename Forward, typename Backward>
void BlockConjugateResidual::through(Layout layout, const Forward& forward, const Backward& backward,
                                     const Vector& x, Vector& y) {
  with_between(forward);
  for_parts([&](std::size_t k, auto places) {
    forward(places);
    backward(k, places);
  });
  subtract_scaled_of_parts(layout, x.data(), y.data());
  with_between([&](auto places) { backward(std::size_t{0}, places); });
}

/// The step of the last iteration, and Â r, into t_, for the next. Every second time without p and z.
BlockConjugateResidual::Dots BlockConjugateResidual::apply(const Ways& ways) {
  return with_layout([&](auto layout) {
    through(
        layout,
        [&](auto places) {
          if (ways.pending == 2) {
            go_forward<Vectors::all_by_two>(layout, places, ways);
          } else {
            go_forward<Vectors::r_and_s>(layout, places, ways);
          }
        },
        [&](std::size_t k, auto places) { dots_[k] = go_backward(layout, places); }, q_, q_);
    Dots total;
    for (std::size_t k = 0; k < pieces(); ++k) total += dots_[k];
    return total;
  });
}

/// The step of an iteration by itself, with what p and z have not gone yet.
void BlockConjugateResidual::go(const Ways& ways) {
  with_layout([&](auto layout) {
    for_pieces([&](std::size_t, auto places) {
      for_each(places, [&](std::size_t j) {
        for_registers(layout, j, [&](std::size_t k) {
          if (ways.pending == 2) {
            advance<Vectors::all_by_two>(ways, k);
          } else {
            advance<Vectors::all_by_one>(ways, k);
          }
        });
      });
    });
  });
}

/// r ← (1 + U)⁻¹ C⁻¹ x, and everything else to zero.
void BlockConjugateResidual::start(std::span<const double> x) {
  rho_ = ss_ = 0.0;
  with_layout([&](auto layout) {
    const auto divide = [&](std::size_t, auto places) {
      for_each_backward(places, [&](std::size_t j) { subtract_scaled(layout, j, r_.data(), r_.data()); });
    };
    const auto scale = [&](auto places) {
      for_each(places, [&](std::size_t j) {
        double* scaled = &wide_[layout.start(j)];
        multiply(layout.stride(j) / row_padding, layout.size(j), &inverse_[inverse_start_[j]], &x[offset_[j]],
                 scaled);
        for_registers(layout, j, [&](std::size_t k) {
          store(&r_[k], narrow(load(&wide_[k])));
          for (Vector* v : {&z_, &p_, &t_, &s_}) store(&(*v)[k], NarrowLanes{});
        });
      });
    };
    if (is_near_) {
      for (const std::size_t j : near_.edge) {
        for_registers(layout, j, [&](std::size_t k) {
          for (Vector* v : {&z_, &t_}) store(&(*v)[k], NarrowLanes{});
          store(&wide_[k], Lanes{});
        });
      }
    }
    through(layout, scale, divide, r_, r_);
  });
}

/// x_j ← C_j⁻ᵀ v_j.
template <typename Layout>
void BlockConjugateResidual::unscale(Layout layout, std::size_t j, const Vector& v, WideVector& scratch,
                                     WideVector& x) const {
  for_registers(layout, j, [&](std::size_t k) { store(&scratch[k], widen(load(&v[k]))); });
  const double *wide = &scratch[layout.start(j)], *inverse = &inverse_[inverse_start_[j]];
  const int stride = layout.stride(j);
  in_sixes(layout.size(j), [&]<int width>(int c) {
    Lanes t[width]{};
    add_lane_products(stride / row_padding, inverse + c * stride, wide, t);
    store_first<width>(&x[layout.start(j)] + c, stride - c, sums(t));
  });
}

/// What x lacks of the solution, as the iteration has it: C (1 + U) r. It is that of the matrix but for what single precision
/// leaves.
void BlockConjugateResidual::find_residual(std::span<double> residual) {
  with_layout([&](auto layout) {
    const auto copy = [&](auto places) {
      for_each(places, [&](std::size_t j) {
        for_registers(layout, j, [&](std::size_t k) { store(&q_[k], -load(&r_[k])); });
      });
    };
    const auto multiply_columns = [&](std::size_t, auto places) {
      for_each_backward(places, [&](std::size_t j) {
        subtract_scaled(layout, j, r_.data(), q_.data());
        float* product = &t_[layout.start(j)];
        multiply(layout.stride(j) / row_padding, layout.size(j), &scale_[inverse_start_[j]],
                 &q_[layout.start(j)], product);
        for (int c = 0; c < layout.size(j); ++c) residual[offset_[j] + at(c)] = -product[c];
      });
    };
    through(layout, copy, multiply_columns, r_, q_);
  });
}

/// product −= A wide, column j and row j of A, but for rows of other ranges.
template <typename Layout>
void BlockConjugateResidual::subtract_product_of(Layout layout, std::size_t j) {
  const double *x = wide_.data(), *x_j = x + layout.start(j), *block = &matrix_[diagonal_[j]];
  double *y = product_.data(), *y_j = y + layout.start(j);
  const int size = layout.size(j), stride = layout.stride(j);
  subtract_times(stride / row_padding, size, block, x_j, y_j);
  block += stride * size;
  subtract_above(layout, j, block, x, y);
  for (std::size_t e = column_start_[j]; e < column_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    subtract_transposed(block, layout.stride(i), size, x + layout.start(i), stride, y_j);
    block += layout.stride(i) * size;
  }
}

/// The same at the edge of a neighbourhood, of row j above the diagonal.
template <typename Layout>
void BlockConjugateResidual::subtract_product_at_edge(Layout layout, std::size_t j) {
  const int size = layout.size(j), stride = layout.stride(j);
  const double* block = &matrix_[diagonal_[j]] + static_cast<std::ptrdiff_t>(stride) * size;
  for (std::size_t e = column_start_[j]; e < column_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    if (near_.has[i] == 1) {
      subtract_transposed(block, layout.stride(i), size, &wide_[layout.start(i)], stride,
                          &product_[layout.start(j)]);
    }
    block += layout.stride(i) * size;
  }
}

/// x += C⁻ᵀ (1 + Uᵀ)⁻¹ z, and residual −= A times that, or residual ← the estimate at hand.
void BlockConjugateResidual::take_over(std::span<double> x, std::span<double> residual, Residual kind) {
  const bool exact = kind == Residual::exact;
  with_layout([&](auto layout) {
    const auto clear_product = [&](std::size_t j) {
      for_registers(layout, j, [&](std::size_t k) { store(&product_[k], Lanes{}); });
    };
    const auto solve = [&](auto places) {
      for_each(places, [&](std::size_t j) {
        store_transposed(layout, j, z_.data(), q_.data());
        for_registers(layout, j, [&](std::size_t k) { store(&z_[k], load(&z_[k]) - load(&q_[k])); });
        unscale(layout, j, z_, product_, wide_);
        if (exact) clear_product(j);
        const double* correction = &wide_[layout.start(j)];
        for (int c = 0; c < layout.size(j); ++c) x[offset_[j] + at(c)] += correction[c];
      });
    };
    const auto multiply_columns = [&](auto places) {
      for_each(places, [&](std::size_t j) { subtract_product_of(layout, j); });
    };
    const Places edge = is_near_ ? Places(near_.edge) : Places();
    for (const std::size_t j : edge) clear_product(j);
    with_between(solve);
    for_parts([&](std::size_t, auto places) {
      solve(places);
      if (exact) multiply_columns(places);
    });
    if (!exact) {
      for_numbers(residual.size(), [&](std::size_t k) { residual[k] = estimate_[k]; });
      return;
    }
    const auto subtract_entry = [&](const RowEntry& entry, std::size_t row) {
      subtract_times(layout.stride(row) / row_padding, layout.size(entry.column), &matrix_[entry.values],
                     &wide_[layout.start(entry.column)], &product_[layout.start(row)]);
    };
    for_entries_between(subtract_entry);
    with_between(multiply_columns);
    const auto add_product_of = [&](std::size_t j) {
      const double* of_block = &product_[layout.start(j)];
      for (int c = 0; c < layout.size(j); ++c) residual[offset_[j] + at(c)] += of_block[c];
    };
    for_pieces([&](std::size_t, auto places) { for_each(places, add_product_of); });
    for (const std::size_t j : edge) {
      if (j < between().last) for_entries(j, subtract_entry);
      subtract_product_at_edge(layout, j);
      add_product_of(j);
    }
  });
}

}  // namespace keyblock::linalg
