#pragma once
#include <string>
#include <string_view>

/// The colours of the report and of Python.
namespace keyblock::picture {

inline constexpr std::string_view rock_color = "#e4e1d8", joint_color = "#33373b", fixed_color = "#d3d5d7",
                                  outline_color = "#c2185b", compression_color = "#0b3c8c",
                                  tension_color = "#d55e00", force_color = "#1d1f22", arrow_color = "#a0187a",
                                  ink_color = "#222222";

/// From little (near the colour of the paper) to much; lightness falls evenly.
enum class ColorMap { magma, mako, viridis };
/// Colours of a map are so many.
inline constexpr int shades = 64;
std::string shade(ColorMap map, int k);
/// The shade of a place on a scale, 0 … 1.
int shade_at(double place);

/// For classes, told apart with defective colour vision, too (Okabe & Ito 2008).
std::string_view class_color(std::size_t k);

}  // namespace keyblock::picture
