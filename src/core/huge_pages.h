#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace keyblock {

/// For arrays that are read from end to end again and again, as factors are: from 1 MB on they take pages of 2 MB, where the
/// system has them (MADV_HUGEPAGE), so that the processor need not look up where each 4 kB are.
template <typename T>
class HugePageAllocator {
 public:
  using value_type = T;  // NOLINT(readability-identifier-naming): the standard asks for this name
  HugePageAllocator() = default;
  template <typename U>
  explicit HugePageAllocator(const HugePageAllocator<U>& /*other*/) {}

  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    if (bytes < worth) return static_cast<T*>(::operator new(bytes));
    const std::size_t whole = (bytes + page - 1) / page * page;
    void* place = ::operator new (whole, std::align_val_t{page});
    ::madvise(place, whole, MADV_HUGEPAGE);  // a wish; without such pages everything works as well
    return static_cast<T*>(place);
  }
  void deallocate(T* place, std::size_t n) {
    if (n * sizeof(T) < worth) return ::operator delete(place);
    ::operator delete (place, std::align_val_t{page});
  }
  friend bool operator==(const HugePageAllocator& /*a*/, const HugePageAllocator& /*b*/) { return true; }

 private:
  static constexpr std::size_t page = std::size_t{1} << 21, worth = page / 2;
};

template <typename T>
using HugePageVector = std::vector<T, HugePageAllocator<T>>;

/// n equal numbers. An array that has to grow gets an eighth more room than it needs, so that the next time it need not: new pages
/// cost more than what is done with them.
template <typename Vector>
void assign_with_room(Vector& numbers, std::size_t n, typename Vector::value_type value) {
  if (n > numbers.capacity()) {
    const bool grows = numbers.capacity() > 0;
    numbers = Vector();
    numbers.reserve(grows ? n + n / 8 : n);
  }
  numbers.assign(n, value);
}

}  // namespace keyblock
