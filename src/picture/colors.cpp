#include "picture/colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace keyblock::picture {
namespace {

constexpr std::uint32_t magma[] = {0xf4efdf, 0xfecf92, 0xfe9f6d, 0xf7705c, 0xde4968,
                                   0xb73779, 0x8c2981, 0x641a80, 0x3b0f70, 0x150e38};
constexpr std::uint32_t mako[] = {0xdef5e5, 0x8bdab2, 0x40b7ad, 0x348fa7, 0x37659e, 0x413d7b, 0x2e1e3b};
constexpr std::uint32_t viridis[] = {0x7ad151, 0x44bf70, 0x22a884, 0x21918c, 0x2a788e,
                                     0x355f8d, 0x414487, 0x482475, 0x440154};

std::span<const std::uint32_t> anchors_of(ColorMap map) {
  if (map == ColorMap::magma) return magma;
  return map == ColorMap::mako ? std::span<const std::uint32_t>(mako) : viridis;
}

}  // namespace

std::string shade(ColorMap map, int k) {
  const auto anchors = anchors_of(map);
  const double x = static_cast<double>(k) / (shades - 1) * static_cast<double>(anchors.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), anchors.size() - 2);
  const auto channel = [&](unsigned shift) {
    const auto of = [&](std::size_t a) { return static_cast<double>((anchors[a] >> shift) & 0xffU); };
    return static_cast<int>(std::lround(std::lerp(of(i), of(i + 1), x - static_cast<double>(i))));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(16), channel(8), channel(0));
}

int shade_at(double place) {
  return static_cast<int>(std::lround(std::clamp(place, 0.0, 1.0) * (shades - 1)));
}

std::string_view class_color(std::size_t k) {
  constexpr std::array<std::string_view, 8> colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                   "#e69f00", "#56b4e9", "#7a5c00", "#b8a900"};
  return colors[k % colors.size()];
}

}  // namespace keyblock::picture
