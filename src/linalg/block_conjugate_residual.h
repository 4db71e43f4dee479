#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/lanes.h"
#include "linalg/block_solver.h"

namespace keyblock::linalg {

/// make_block_conjugate_residual(). Its pattern is found in block_conjugate_residual_pattern.cpp, the matrix made ready in
/// block_conjugate_residual_factor.cpp; what iterations are made of is in block_conjugate_residual_passes.cpp;
/// block_conjugate_residual_near.cpp solves near some blocks alone.
///
/// Blocks are scaled so that those on the diagonal are one: with A_jj = C_j C_jᵀ, the matrix is C (Uᵀ + 1 + U) Cᵀ with
/// U_ij = C_i⁻¹ A_ij C_j⁻ᵀ strictly above the diagonal. Preconditioned from both sides by (1 + U) it is
///
///     Â r = t + (1 + U)⁻¹ (r − t),     t = (1 + Uᵀ)⁻¹ r
///
/// Conjugate residuals (Stiefel 1955) make the norm of r smallest, where conjugate gradients make that of the error: it is what is out of
/// balance that ends the iteration. With s = Â p:
///
///     β = r·Âr / (r·Âr of the last iteration),   p ← r + β p,   s ← Â r + β s,   α = r·Âr / s·s,   z ← z + α p,   r ← r − α s
///
/// U and the vectors have single precision: half the memory to read in every iteration, and half the instructions. A few digits of
/// the solution are found so; the residual is then that of the matrix itself, and asks for more where they do not do.
/// Vectors are padded as the blocks are. In the order of `partition`, the parts follow each other, each forward, with the memory,
/// and backward while a cache has it, or go at the same time, by as many threads as there are; sums go part by part.
class BlockConjugateResidual final : public BlockSolver {
 public:
  explicit BlockConjugateResidual(ThreadTeam* team) : team_(team) {}
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override;
  double* diagonal(int block) override { return &matrix_[diagonal_[place_[at(block)]]]; }
  BlockSlot slot(int pair) override { return slots_[at(pair)]; }
  void touch(int block) override {
    const std::size_t place = place_[at(block)];
    if (std::exchange(stale_[place], std::uint8_t{1}) == 0)
      stale_places_.push_back(static_cast<std::uint32_t>(place));
  }
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;
  void improve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;
  [[nodiscard]] bool solves_near() const override { return true; }
  bool find_near(std::span<const std::size_t> blocks, Reach& reach) override;
  void solve_near(std::span<double> x, std::span<double> residual, const Excess& excess) override;
  [[nodiscard]] bool solved() const override { return solved_; }
  [[nodiscard]] bool serves_later_steps() const override { return true; }

 private:
  static constexpr int most_iterations = 400;
  /// By which the residual may be larger than before; beyond that the matrix is not positive definite.
  static constexpr double most_growth = 100.0;
  using Vector = std::vector<float>;
  using WideVector = std::vector<double>;
  struct Range {
    std::size_t first, last;  ///< places
  };
  using Places = std::span<const std::uint32_t>;
  template <typename Body>
  static void for_each(Range range, const Body& body) {
    for (std::size_t j = range.first; j < range.last; ++j) body(j);
  }
  template <typename Body>
  static void for_each_backward(Range range, const Body& body) {
    for (std::size_t j = range.last; j-- > range.first;) body(j);
  }
  template <typename Body>
  static void for_each(Places places, const Body& body) {
    for (const std::size_t j : places) body(j);
  }
  template <typename Body>
  static void for_each_backward(Places places, const Body& body) {
    for (auto j = places.rbegin(); j != places.rend(); ++j) body(std::size_t{*j});
  }
  /// The neighbourhood of some blocks, of which a system may be.
  struct Near {
    std::vector<std::uint32_t> places;  ///< ascending: those between the parts, and then part by part
    std::vector<std::size_t> begin;     ///< of these, into places
    std::vector<std::uint32_t> edge;    ///< places that are coupled with these, and not of them
    std::vector<std::uint8_t> has;      ///< per place: 1 for these, at_edge for those
    [[nodiscard]] Places piece(std::size_t k) const {
      return Places(places).subspan(begin[k], begin[k + 1] - begin[k]);
    }
  };
  static constexpr std::uint8_t at_edge = 2;
  /// The step of an iteration: p ← γ r + β p, s ← γ Â r + β s, z ← z + α p, r ← r − α s, with γ = 1; or none.
  struct Way {
    float alpha = 0.0F, beta = 1.0F, gamma = 0.0F;
  };
  /// Of the last iteration; and of the one before it where p and z have not gone that: they go two at a time, to be read and written half
  /// as often. What r was, for the first of the two, follows from what it is and s.
  struct Ways {
    Way last, before;
    int pending = 0;  ///< how many p and z have not gone
    void take(Way next) {
      before = last;
      last = next;
      pending = pending == 1 ? 2 : 1;
    }
  };
  /// What takes steps: r and s alone, the last one; p and z that, too; or p and z both.
  enum class Vectors { r_and_s, all_by_one, all_by_two };
  /// Dot products of an iteration, with q = Â r. They give s · s, as each s is orthogonal to the last one, and r · r after it too.
  struct Dots {
    double rr = 0.0, rq = 0.0, qq = 0.0;
    Dots& operator+=(const Dots& other) {
      rr += other.rr;
      rq += other.rq;
      qq += other.qq;
      return *this;
    }
  };

  void place_vectors(std::span<const int> sizes, std::span<const int> order);
  void find_neighbours(std::span<const std::pair<int, int>> pairs);
  [[nodiscard]] Places neighbours(std::size_t place) const {
    return Places(neighbours_)
        .subspan(neighbours_start_[place], neighbours_start_[place + 1] - neighbours_start_[place]);
  }
  bool collect_near(std::span<const std::size_t> blocks);
  std::vector<std::size_t> place_matrix(std::span<const std::pair<int, int>> pairs);
  template <typename Body>
  decltype(auto) with_layout(const Body& body) const;
  /// Calls body(k) for k from 1 to `count`, which may go at the same time.
  template <typename Body>
  void for_piece_numbers(std::size_t count, const Body& body) const {
    const auto some = [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from + 1; k <= to; ++k) body(k);
    };
    if (team_ == nullptr || count <= 1) {
      some(0, count);
    } else {
      team_->for_range(count, 2, some);
    }
  }
  /// Calls body(k, range) for what lies between the parts, 0, and then for every part: all of the matrix.
  template <typename Body>
  void for_ranges(const Body& body) const {
    body(std::size_t{0}, between());
    for_piece_numbers(begin_.size() - 2, [&](std::size_t k) { body(k, Range{begin_[k], begin_[k + 1]}); });
  }
  /// Calls body(k, places) for every part, from 1 on, of what is solved.
  template <typename Body>
  void for_parts(const Body& body) const {
    for_piece_numbers(pieces() - 1, [&](std::size_t k) {
      if (is_near_) {
        body(k, near_.piece(k));
      } else {
        body(k, Range{begin_[k], begin_[k + 1]});
      }
    });
  }
  /// Of what is solved: its parts, and what lies between them.
  [[nodiscard]] std::size_t pieces() const { return (is_near_ ? near_.begin : begin_).size() - 1; }
  /// body(places) for what lies between them.
  template <typename Body>
  decltype(auto) with_between(const Body& body) const {
    return is_near_ ? body(near_.piece(0)) : body(between());
  }
  /// Calls body(k, places) for what lies between the parts of what is solved, 0, and then for every part.
  template <typename Body>
  void for_pieces(const Body& body) const {
    with_between([&](auto places) { body(std::size_t{0}, places); });
    for_parts(body);
  }
  /// Of all the matrix.
  [[nodiscard]] Range between() const { return {0, begin_[1]}; }
  /// Calls body(row) for what lies between the parts of what is solved; rows may go at the same time.
  template <typename Body>
  void for_rows_between(const Body& body) const {
    constexpr std::size_t worth_threads = 64;
    const std::size_t count = is_near_ ? near_.begin[1] : between().last;
    const auto some = [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) body(is_near_ ? std::size_t{near_.places[k]} : k);
    };
    if (team_ == nullptr) {
      some(0, count);
    } else {
      team_->for_range(count, worth_threads, some);
    }
  }
  /// Calls body(k) for the numbers of a vector.
  template <typename Body>
  void for_numbers(std::size_t n, const Body& body) const {
    constexpr std::size_t worth_threads = 20'000;
    const auto some = [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) body(k);
    };
    if (team_ == nullptr) {
      some(0, n);
    } else {
      team_->for_range(n, worth_threads, some);
    }
  }
  template <typename Layout, typename Number>
  void subtract_above(Layout layout, std::size_t j, const Number* block, const Number* x, Number* y) const;
  template <typename Layout>
  void subtract_scaled(Layout layout, std::size_t j, const float* x, float* y) const;
  template <typename Subtract>
  void for_entries(std::size_t row, const Subtract& subtract) const;
  template <typename Subtract>
  void for_entries_between(const Subtract& subtract) const;
  template <typename Layout>
  void subtract_scaled_of_parts(Layout layout, const float* x, float* y) const;
  template <typename Layout>
  void store_transposed(Layout layout, std::size_t j, const float* x, float* y) const;
  template <Vectors vectors>
  NarrowLanes advance(const Ways& ways, std::size_t k);
  template <Vectors vectors, typename Layout, typename Some>
  void go_forward(Layout layout, Some places, const Ways& ways);
  template <typename Layout, typename Some>
  [[nodiscard]] Dots go_backward(Layout layout, Some places);
  template <typename Layout, typename Forward, typename Backward>
  void through(Layout layout, const Forward& forward, const Backward& backward, const Vector& x, Vector& y);
  Dots apply(const Ways& ways);
  void go(const Ways& ways);
  void start(std::span<const double> x);
  template <typename Layout>
  void unscale(Layout layout, std::size_t j, const Vector& v, WideVector& scratch, WideVector& x) const;
  template <typename Layout>
  void subtract_product_of(Layout layout, std::size_t j);
  template <typename Layout>
  void subtract_product_at_edge(Layout layout, std::size_t j);
  void find_residual(std::span<double> residual);
  void take_over(std::span<double> x, std::span<double> residual, Residual kind);
  /// Numbers of block (i, j) of U.
  [[nodiscard]] std::size_t scaled_count(std::size_t i, std::size_t j) const;
  void scale_block(std::size_t i, std::size_t j, const double* a, double* scaled) const;
  void store_scaled(std::size_t i, std::size_t j, const double* scaled, float* above) const;
  bool scale_diagonal(std::size_t j, WideVector& scratch);
  void scale_above(std::size_t j, WideVector& scratch);
  void copy_row_between(std::size_t row);
  bool factor_all();
  bool factor_touched();
  /// What iterate() took, and whether the estimate of the residual is small enough.
  struct Iterations {
    int count;
    bool enough;
  };
  Iterations iterate(double too_large, const Excess& excess, int most);
  void approach(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind);

  // Everything is by place in the order of the partition, but for the slots.
  ThreadTeam* team_;
  std::vector<std::size_t> place_;  ///< block → place
  std::vector<int> block_at_;       ///< place → block
  std::vector<std::size_t> begin_;  ///< Partition::begin
  Near near_;
  bool is_near_ = false;                       ///< what is solved is that, and not all
  std::vector<std::uint32_t> neighbours_;      ///< places that a place is coupled with
  std::vector<std::size_t> neighbours_start_;  ///< per place
  std::vector<int> size_, stride_;
  std::vector<std::size_t> offset_;  ///< its unknowns in x
  std::vector<std::size_t> start_;   ///< into padded vectors
  bool same_ = false;                ///< all blocks have 6 unknowns
  /// Blocks above the diagonal, column by column, first those of rows between the parts.
  std::vector<std::uint32_t> rows_;          ///< of each, < column
  std::vector<std::uint32_t> column_start_;  ///< per column, into rows_
  std::vector<std::uint32_t> own_start_;     ///< likewise: the first whose row lies in the same range
  std::vector<std::size_t> diagonal_;        ///< per column, into matrix_: A_jj, followed by what is above it
  std::vector<std::size_t> above_start_;     ///< per column, into above_
  std::vector<std::size_t> inverse_start_;   ///< per column, into inverse_ and scale_
  /// A block of a row between the parts whose column lies in one of them.
  struct RowEntry {
    std::size_t column;
    std::size_t values, above;  ///< into matrix_, above_
    std::size_t copy;           ///< into above_by_rows_
  };
  std::vector<std::size_t> row_start_;  ///< per block between the parts, into row_entries_
  std::vector<RowEntry> row_entries_;   ///< of a row, by columns
  std::vector<BlockSlot> slots_;
  WideVector matrix_;   ///< A
  WideVector inverse_;  ///< C_j⁻¹
  Vector scale_;        ///< C_j
  Vector above_;        ///< U, by paired_columns where all blocks have 6 unknowns
  /// That of row_entries_ once more, in their order: where rows gather from above_, they wait for the memory at each block.
  Vector above_by_rows_;
  std::vector<std::uint8_t> stale_;  ///< per place: what belongs to the diagonal block is to be found anew
  std::vector<std::uint32_t> stale_places_;  ///< these, but where all are
  bool all_stale_ = true;
  std::vector<std::uint32_t>
      touched_;                   ///< scratch: places in whose columns or rows something is to be scaled anew
  int largest_ = 0;               ///< stride of a block
  Vector t_, z_, r_, p_, q_, s_;  ///< padded; between iterations Â r is in t_
  WideVector wide_, product_;     ///< padded: scratch
  std::vector<double> estimate_;  ///< of the residual
  std::vector<Dots> dots_;        ///< per range
  /// Of the last solutions with this matrix: by how much less the square of the residual fell than that of its norm in the scaled
  /// system; 0: not known.
  std::array<double, 3> lag_{}, lag_near_{};
  double rho_ = 0.0;  ///< r · Â r of the last iteration; 0: the next is the first
  double ss_ = 0.0;   ///< s · s of that
  bool solved_ = true;
};

}  // namespace keyblock::linalg
