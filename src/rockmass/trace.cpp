#include "rockmass/trace.h"

namespace keyblock::rockmass {

std::vector<int> trace_numbers(const std::vector<Trace>& pieces) {
  std::vector<int> numbers;
  numbers.reserve(pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const bool goes_on = k > 0 && pieces[k].number >= 0 && pieces[k].number == pieces[k - 1].number &&
                         pieces[k].source == pieces[k - 1].source;
    numbers.push_back(k == 0 ? 0 : numbers.back() + (goes_on ? 0 : 1));
  }
  return numbers;
}

}  // namespace keyblock::rockmass
