#pragma once
#include <string>
#include <string_view>

/// What all pictures of the program have in common that are written as SVG. Lengths in units of the picture, y downwards.
namespace keyblock {

/// The first lines of a picture, with its white paper. It ends with svg_end.
std::string svg_begin(double width, double height, int font_size);
inline constexpr std::string_view svg_end = "</svg>\n";

/// Appends a number as "{:.2f}" would: a picture of many blocks is nothing but millions of these.
void svg_number(std::string& to, double x);

/// Appends a command of a path with its point, "M1.00 2.00".
void svg_point(std::string& to, char command, double x, double y);

/// Text that begins, ends or has its middle ("start", "end", "middle") at a point. It is escaped; `more` are further attributes.
std::string svg_text(double x, double y, std::string_view anchor, std::string_view text,
                     std::string_view more = {});

}  // namespace keyblock
