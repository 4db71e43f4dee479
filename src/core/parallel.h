#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace keyblock {

/// A fixed team of threads for loops whose iterations are independent. Range [0, n) is cut into one
/// contiguous piece per thread; as no result depends on which thread computed it, any number of threads gives
/// the same bits.
class ThreadTeam {
 public:
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  [[nodiscard]] int size() const { return size_; }

  /// Calls body(begin, end) on disjoint pieces of [0, n); serial when n < grain or the team has one thread.
  /// The first exception thrown by a piece is thrown again here.
  void for_range(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

 private:
  struct Shared;
  int size_;
  std::unique_ptr<Shared> shared_;
};

}  // namespace keyblock
