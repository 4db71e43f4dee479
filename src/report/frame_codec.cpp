#include "report/frame_codec.h"

#include <algorithm>
#include <cmath>

namespace keyblock::report {

namespace {

std::uint32_t quantised(double x, double quantum) {
  if (std::isnan(x)) return 0;
  return static_cast<std::uint32_t>(
      static_cast<std::int32_t>(std::lround(std::clamp(x / quantum, -most_quanta, most_quanta))));
}

std::uint32_t zigzag(std::uint32_t e) {
  return e << 1 ^ (e >> 31 ? ~0U : 0U);
}

std::uint32_t unzigzag(std::uint32_t z) {
  return z >> 1 ^ (z & 1U ? ~0U : 0U);
}

}  // namespace

std::vector<std::uint8_t> encode_frames(std::size_t frames, std::size_t columns, double quantum,
                                        const std::function<double(std::size_t, std::size_t)>& value) {
  const std::size_t n = frames * columns;
  std::vector<std::uint8_t> bytes(4 * n);
  std::vector<std::uint32_t> previous(columns, 0);
  for (std::size_t f = 0; f < frames; ++f) {
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < columns; ++i) {
      const std::uint32_t now = quantised(value(f, i), quantum);
      const std::uint32_t d = now - previous[i];
      const std::uint32_t z = zigzag(d - left);
      left = d;
      previous[i] = now;
      for (std::size_t k = 0; k < 4; ++k)
        bytes[k * n + f * columns + i] = static_cast<std::uint8_t>(z >> (8 * k) & 255U);
    }
  }
  return bytes;
}

std::vector<double> decode_frames(std::span<const std::uint8_t> bytes, std::size_t frames,
                                  std::size_t columns, double quantum) {
  const std::size_t n = frames * columns;
  std::vector<double> values(n);
  std::vector<std::uint32_t> row(columns, 0);
  for (std::size_t f = 0; f < frames; ++f) {
    std::uint32_t d = 0;
    for (std::size_t i = 0; i < columns; ++i) {
      std::uint32_t z = 0;
      for (std::size_t k = 0; k < 4; ++k) z |= std::uint32_t{bytes[k * n + f * columns + i]} << (8 * k);
      d += unzigzag(z);
      row[i] += d;
      values[f * columns + i] = quantum * static_cast<double>(static_cast<std::int32_t>(row[i]));
    }
  }
  return values;
}

}  // namespace keyblock::report
