#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace keyblock {

/// That this process may use, at least one.
int processors();

/// A fixed team of threads for loops whose iterations are independent. Range [0, n) is cut into one
/// contiguous piece per thread; as no result depends on which thread computed it, any number of threads gives
/// the same bits.
class ThreadTeam {
 public:
  /// Throws RunError where the system does not give that many threads.
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  [[nodiscard]] int size() const { return size_; }

  /// Calls body(begin, end) on disjoint pieces of [0, n); serial when n < grain or the team has one thread.
  /// Where pieces throw, the exception of the first of them in [0, n) is thrown again here, the others are dropped.
  void for_range(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

 private:
  struct Shared;
  int size_;
  std::unique_ptr<Shared> shared_;
};

/// The i < n for which is(i), ascending. Piece by piece, by the threads of the team when n is at least `grain`. They are few: where none of
/// i … i + group − 1 is, any_from(i), which may look beyond n, says so for most.
template <std::size_t group, typename AnyFrom, typename Is>
void find_few(ThreadTeam& team, std::size_t n, std::size_t grain, const AnyFrom& any_from, const Is& is,
              std::vector<std::size_t>& found) {
  const auto look_at = [&](std::size_t begin, std::size_t end, std::vector<std::size_t>& out) {
    for (std::size_t first = begin; first < end; first += group) {
      if (!any_from(first)) continue;
      for (std::size_t i = first; i < end && i < first + group; ++i) {
        if (is(i)) out.push_back(i);
      }
    }
  };
  found.clear();
  if (team.size() == 1 || n < grain) return look_at(0, n, found);
  constexpr std::size_t piece = 4'096;
  static_assert(piece % group == 0);
  std::vector<std::vector<std::size_t>> of_piece((n + piece - 1) / piece);
  team.for_range(of_piece.size(), 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) look_at(p * piece, std::min(n, (p + 1) * piece), of_piece[p]);
  });
  for (const auto& some : of_piece) found.insert(found.end(), some.begin(), some.end());
}

/// The i < n for which is(i), likewise, each looked at.
template <typename Is>
void find_all(ThreadTeam& team, std::size_t n, std::size_t grain, const Is& is,
              std::vector<std::size_t>& found) {
  find_few<1>(
      team, n, grain, [](std::size_t) { return true; }, is, found);
}

/// Σ of(i), i < n: piece by piece, which are the same for any number of threads. T: a number, or what has += and begins at zero.
template <typename T, typename Of>
T sum_of(ThreadTeam& team, std::size_t n, std::size_t grain, const Of& of) {
  constexpr std::size_t piece = 4'096;
  std::vector<T> of_piece((n + piece - 1) / piece, T{});
  const auto add = [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      T sum{};
      for (std::size_t i = p * piece; i < n && i < (p + 1) * piece; ++i) sum += of(i);
      of_piece[p] = sum;
    }
  };
  if (n < grain) {
    add(0, of_piece.size());
  } else {
    team.for_range(of_piece.size(), 2, add);
  }
  T total{};
  for (const T& some : of_piece) total += some;
  return total;
}

/// The largest of(i), i < n, and of 0.
template <typename Of>
double largest_of(ThreadTeam& team, std::size_t n, std::size_t grain, const Of& of) {
  const auto largest = [&](std::size_t begin, std::size_t end) {
    double found = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (const double x = of(i); x > found) found = x;
    }
    return found;
  };
  if (team.size() == 1 || n < grain) return largest(0, n);
  const std::size_t pieces = static_cast<std::size_t>(team.size());
  std::vector<double> of_piece(pieces);
  team.for_range(pieces, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) of_piece[p] = largest(n * p / pieces, n * (p + 1) / pieces);
  });
  double found = 0.0;
  for (const double x : of_piece) {
    if (x > found) found = x;
  }
  return found;
}

}  // namespace keyblock
