#include "linalg/residual_passes.h"

#include "core/assign_with_room.h"
#include "linalg/upper_kernels.h"

namespace keyblock::linalg {

namespace {

/// Once through all that is solved: forward(positions), then backward(k, positions) of each part while a cache has it, and of what lies between
/// them, which comes first forward and last backward: when y −= U x has been done for the columns of the parts.
template <typename Layout, typename Forward, typename Backward>
void sweep(const ScaledMatrix& matrix, const SolvedPart& part, Layout layout, const Forward& forward,
           const Backward& backward, const std::vector<float>& x, std::vector<float>& y) {
  part.with_between(forward);
  part.for_parts([&](std::size_t k, auto positions) {
    forward(positions);
    backward(k, positions);
  });
  subtract_scaled_of_parts(matrix, part, layout, x.data(), y.data());
  part.with_between([&](auto positions) { backward(std::size_t{0}, positions); });
}

}  // namespace

void ResidualPasses::analyse(const BlockOrder& order) {
  for (Vector* v : {&t_, &z_, &r_, &p_, &q_, &s_}) assign_with_room(*v, order.padded, 0.0F);
  for (WideVector* v : {&wide_, &product_}) assign_with_room(*v, order.padded, 0.0);
  dots_.assign(order.begin.size() - 1, {});
}

/// The step of the last iteration, of one register, Â r being in t_. Returns r after it.
template <ResidualPasses::Vectors vectors>
inline NarrowLanes ResidualPasses::advance(const PendingSteps& steps, std::size_t k) {
  const IterationStep& last = steps.last;
  const NarrowLanes alpha = broadcast(last.alpha), beta = broadcast(last.beta), gamma = broadcast(last.gamma),
                    r = load(&r_[k]), last_s = load(&s_[k]), s = gamma * load(&t_[k]) + beta * last_s,
                    after = r - alpha * s;
  if constexpr (vectors != Vectors::r_and_s) {
    NarrowLanes p = load(&p_[k]), z = load(&z_[k]);
    if constexpr (vectors == Vectors::all_by_two) {
      const NarrowLanes last_alpha = broadcast(steps.before.alpha), last_r = r + last_alpha * last_s;
      p = last_r + broadcast(steps.before.beta) * p;
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

/// The step of the last iteration; then t ← (1 + Uᵀ)⁻¹ r and q ← r − t, of some positions. No calls within: they would keep vectors from
/// staying in registers.
template <ResidualPasses::Vectors vectors, typename Layout, typename Some>
[[gnu::flatten]] void ResidualPasses::forward_pass(const ScaledMatrix& matrix, Layout layout, Some positions,
                                                   const PendingSteps& steps) {
  for_each_position(positions, [&](std::size_t j) {
    store_transposed(matrix, layout, j, t_.data(), q_.data());
    for_registers(layout, j,
                  [&](std::size_t k) { store(&t_[k], advance<vectors>(steps, k) - load(&q_[k])); });
  });
}

/// q ← (1 + U)⁻¹ q and t ← t + q, which is Â r, of some positions, except for what columns elsewhere add to their rows.
template <typename Layout, typename Some>
[[gnu::flatten]] IterationDots ResidualPasses::backward_pass(const ScaledMatrix& matrix, Layout layout,
                                                             Some positions) {
  Lanes rr{}, rq{}, qq{};
  for_each_backward(positions, [&](std::size_t j) {
    subtract_scaled(matrix, layout, j, q_.data(), q_.data());
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

IterationDots ResidualPasses::apply(const ScaledMatrix& matrix, const SolvedPart& part,
                                    const PendingSteps& steps) {
  return with_layout(part.order(), [&](auto layout) {
    sweep(
        matrix, part, layout,
        [&](auto positions) {
          if (steps.count == 2) {
            forward_pass<Vectors::all_by_two>(matrix, layout, positions, steps);
          } else {
            forward_pass<Vectors::r_and_s>(matrix, layout, positions, steps);
          }
        },
        [&](std::size_t k, auto positions) { dots_[k] = backward_pass(matrix, layout, positions); }, q_, q_);
    IterationDots total;
    for (std::size_t k = 0; k < part.pieces(); ++k) total += dots_[k];
    return total;
  });
}

void ResidualPasses::take(const SolvedPart& part, const PendingSteps& steps) {
  with_layout(part.order(), [&](auto layout) {
    part.for_pieces([&](std::size_t, auto positions) {
      for_each_position(positions, [&](std::size_t j) {
        for_registers(layout, j, [&](std::size_t k) {
          if (steps.count == 2) {
            advance<Vectors::all_by_two>(steps, k);
          } else {
            advance<Vectors::all_by_one>(steps, k);
          }
        });
      });
    });
  });
}

void ResidualPasses::clear_solution(const SolvedPart& part) {
  part.for_numbers(z_.size(), [&](std::size_t k) { z_[k] = 0.0F; });
}

void ResidualPasses::start(const ScaledMatrix& matrix, const SolvedPart& part,
                           std::span<const double> residual) {
  with_layout(part.order(), [&](auto layout) {
    const auto divide = [&](std::size_t, auto positions) {
      for_each_backward(positions,
                        [&](std::size_t j) { subtract_scaled(matrix, layout, j, r_.data(), r_.data()); });
    };
    const auto scale = [&](auto positions) {
      for_each_position(positions, [&](std::size_t j) {
        double* scaled = &wide_[layout.start(j)];
        multiply(layout.stride(j) / row_padding, layout.size(j), matrix.inverse(j),
                 &residual[part.order().offset[j]], scaled);
        for_registers(layout, j, [&](std::size_t k) {
          store(&r_[k], narrow(load(&wide_[k])));
          for (Vector* v : {&z_, &p_, &t_, &s_}) store(&(*v)[k], NarrowLanes{});
        });
      });
    };
    for (const std::size_t j : part.edge()) {
      for_registers(layout, j, [&](std::size_t k) {
        for (Vector* v : {&z_, &t_}) store(&(*v)[k], NarrowLanes{});
        store(&wide_[k], Lanes{});
      });
    }
    sweep(matrix, part, layout, scale, divide, r_, r_);
  });
}

void ResidualPasses::estimate_residual(const ScaledMatrix& matrix, const SolvedPart& part,
                                       std::span<double> residual) {
  with_layout(part.order(), [&](auto layout) {
    const auto copy = [&](auto positions) {
      for_each_position(positions, [&](std::size_t j) {
        for_registers(layout, j, [&](std::size_t k) { store(&q_[k], -load(&r_[k])); });
      });
    };
    const auto multiply_columns = [&](std::size_t, auto positions) {
      for_each_backward(positions, [&](std::size_t j) {
        subtract_scaled(matrix, layout, j, r_.data(), q_.data());
        float* product = &t_[layout.start(j)];
        multiply(layout.stride(j) / row_padding, layout.size(j), matrix.scale(j), &q_[layout.start(j)],
                 product);
        for (int c = 0; c < layout.size(j); ++c) residual[part.order().offset[j] + at(c)] = -product[c];
      });
    };
    sweep(matrix, part, layout, copy, multiply_columns, r_, q_);
  });
}

/// z ← (1 + Uᵀ)⁻¹ z, wide ← C⁻ᵀ z, and x += wide, of some positions; product ← 0 for what follows.
template <typename Layout, typename Some>
void ResidualPasses::correct(const ScaledMatrix& matrix, Layout layout, Some positions, std::span<double> x) {
  const std::vector<std::size_t>& offset = matrix.order().offset;
  for_each_position(positions, [&](std::size_t j) {
    store_transposed(matrix, layout, j, z_.data(), q_.data());
    for_registers(layout, j, [&](std::size_t k) { store(&z_[k], load(&z_[k]) - load(&q_[k])); });
    unscale(matrix, layout, j, z_.data(), product_.data(), wide_.data());
    for_registers(layout, j, [&](std::size_t k) { store(&product_[k], Lanes{}); });
    const double* correction = &wide_[layout.start(j)];
    for (int c = 0; c < layout.size(j); ++c) x[offset[j] + at(c)] += correction[c];
  });
}

void ResidualPasses::add_solution(const ScaledMatrix& matrix, const SolvedPart& part, std::span<double> x) {
  with_layout(part.order(), [&](auto layout) {
    part.for_pieces([&](std::size_t, auto positions) { correct(matrix, layout, positions, x); });
  });
}

void ResidualPasses::add_solution(const ScaledMatrix& matrix, const SolvedPart& part, std::span<double> x,
                                  std::span<double> residual) {
  with_layout(part.order(), [&](auto layout) {
    const auto solve = [&](auto positions) { correct(matrix, layout, positions, x); };
    const auto multiply_columns = [&](auto positions) {
      for_each_position(positions, [&](std::size_t j) {
        subtract_product_of(matrix, layout, j, wide_.data(), product_.data());
      });
    };
    for (const std::size_t j : part.edge())
      for_registers(layout, j, [&](std::size_t k) { store(&product_[k], Lanes{}); });
    part.with_between(solve);
    part.for_parts([&](std::size_t, auto positions) {
      solve(positions);
      multiply_columns(positions);  // while a cache has the part
    });
    const auto subtract_entry = [&](const UpperPattern::RowEntry& entry, std::size_t row) {
      subtract_times(layout.stride(row) / row_padding, layout.size(entry.column),
                     matrix.values() + entry.values, &wide_[layout.start(entry.column)],
                     &product_[layout.start(row)]);
    };
    for_entries_between(matrix, part, subtract_entry);
    part.with_between(multiply_columns);
    const auto add_product_of = [&](std::size_t j) {
      const double* of_block = &product_[layout.start(j)];
      for (int c = 0; c < layout.size(j); ++c) residual[part.order().offset[j] + at(c)] += of_block[c];
    };
    part.for_pieces([&](std::size_t, auto positions) { for_each_position(positions, add_product_of); });
    for (const std::size_t j : part.edge()) {
      if (j < part.order().between()) for_entries(matrix, part, j, subtract_entry);
      subtract_product_at_edge(matrix, part, layout, j, wide_.data(), product_.data());
      add_product_of(j);
    }
  });
}

}  // namespace keyblock::linalg
