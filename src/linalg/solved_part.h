#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/parallel.h"
#include "linalg/block_order.h"
#include "linalg/neighbourhood.h"
#include "linalg/numbers.h"

namespace keyblock::linalg {

/// Positions that follow each other, and some positions, ascending.
struct PositionRange {
  std::size_t first, last;
};
using Positions = std::span<const std::uint32_t>;

template <typename Body>
void for_each_position(PositionRange range, const Body& body) {
  for (std::size_t j = range.first; j < range.last; ++j) body(j);
}
template <typename Body>
void for_each_position(Positions positions, const Body& body) {
  for (const std::size_t j : positions) body(j);
}
template <typename Body>
void for_each_backward(PositionRange range, const Body& body) {
  for (std::size_t j = range.last; j-- > range.first;) body(j);
}
template <typename Body>
void for_each_backward(Positions positions, const Body& body) {
  for (auto j = positions.rbegin(); j != positions.rend(); ++j) body(std::size_t{*j});
}

/// What a system is solved of: all blocks, or a neighbourhood. Piece 0 is what lies between the parts; the others are the parts, which threads may
/// work on at the same time. Loops call with a PositionRange of all blocks, and with Positions of a neighbourhood.
class SolvedPart {
 public:
  /// local: null for all blocks. team: null for this thread alone.
  SolvedPart(const BlockOrder& order, const Neighbourhood* local, ThreadTeam* team)
      : order_(order), local_(local), team_(team) {}
  [[nodiscard]] const BlockOrder& order() const { return order_; }
  [[nodiscard]] const Neighbourhood* local() const { return local_; }
  [[nodiscard]] bool has(std::size_t position) const { return local_ == nullptr || local_->has(position); }
  [[nodiscard]] std::size_t pieces() const {
    return local_ != nullptr ? local_->pieces() : order_.begin.size() - 1;
  }
  /// Positions beside a neighbourhood, whose residual its solution changes.
  [[nodiscard]] Positions edge() const { return local_ != nullptr ? local_->edge() : Positions(); }

  /// body(positions) for what lies between the parts.
  template <typename Body>
  decltype(auto) with_between(const Body& body) const {
    return local_ != nullptr ? body(local_->piece(0)) : body(PositionRange{0, order_.between()});
  }
  /// Calls body(k, positions) for every part, from 1 on.
  template <typename Body>
  void for_parts(const Body& body) const {
    in_threads(pieces() - 1, 2, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from + 1; k <= to; ++k) {
        if (local_ != nullptr) {
          body(k, local_->piece(k));
        } else {
          body(k, PositionRange{order_.begin[k], order_.begin[k + 1]});
        }
      }
    });
  }
  /// Calls body(k, positions) for what lies between the parts, 0, and then for every part.
  template <typename Body>
  void for_pieces(const Body& body) const {
    with_between([&](auto positions) { body(std::size_t{0}, positions); });
    for_parts(body);
  }
  /// Calls body(position) for what lies between the parts; several may be worked on at the same time.
  template <typename Body>
  void for_rows_between(const Body& body) const {
    const std::size_t count = local_ != nullptr ? local_->piece(0).size() : order_.between();
    in_threads(count, numbers::rows_worth_threads, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        body(local_ != nullptr ? std::size_t{local_->positions()[k]} : k);
    });
  }
  /// Calls body(k) for the numbers of a vector.
  template <typename Body>
  void for_numbers(std::size_t n, const Body& body) const {
    in_threads(n, numbers::numbers_worth_threads, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) body(k);
    });
  }

 private:
  template <typename Some>
  void in_threads(std::size_t count, std::size_t grain, const Some& some) const {
    if (team_ == nullptr || count <= 1) {
      some(std::size_t{0}, count);
    } else {
      team_->for_range(count, grain, some);
    }
  }

  const BlockOrder& order_;
  const Neighbourhood* local_;
  ThreadTeam* team_;
};

}  // namespace keyblock::linalg
