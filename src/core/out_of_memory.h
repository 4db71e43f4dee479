#pragma once
#include <new>
#include <string>

#include "core/error.h"

namespace keyblock {

/// A sentence for people: what the program had taken when it was given no more, and what for, if that is known: `a model of 20
/// blocks`.
std::string out_of_memory_text(const std::string& purpose);

/// What `work` returns. Where memory runs out in it, a RunError says so in a sentence; `purpose()` says what the memory was for.
template <class Purpose, class Work>
decltype(auto) with_memory_for(const Purpose& purpose, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw RunError(out_of_memory_text(purpose()));
  }
}

}  // namespace keyblock
