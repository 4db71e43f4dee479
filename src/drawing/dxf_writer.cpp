#include "drawing/dxf_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "drawing/layer_name.h"

namespace keyblock::drawing {
namespace {

std::string layer_of_r12(std::string_view name) {
  constexpr std::size_t longest = 31;
  std::string out = capitals(name.substr(0, longest));
  for (char& c : out) {
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '$';
    if (!plain) c = '_';
  }
  return out.empty() ? "0" : out;
}

}  // namespace

void DxfWriter::polyline(std::string_view layer_name, std::span<const Vec2> vertices, bool closed) {
  const std::string layer = layer_of_r12(layer_name);
  const auto place = std::ranges::lower_bound(layers_, layer);
  if (place == layers_.end() || *place != layer) layers_.insert(place, layer);
  auto out = std::back_inserter(entities_);
  fmt::format_to(out, "0\nPOLYLINE\n8\n{}\n66\n1\n10\n0.0\n20\n0.0\n30\n0.0\n70\n{}\n", layer,
                 closed ? 1 : 0);
  for (const Vec2 p : vertices)
    fmt::format_to(out, "0\nVERTEX\n8\n{}\n10\n{}\n20\n{}\n30\n0.0\n", layer, p.x, p.y);
  fmt::format_to(out, "0\nSEQEND\n8\n{}\n", layer);
}

std::string DxfWriter::text() const {
  std::string layers;
  constexpr int colours = 6;  // from red to magenta
  for (std::size_t k = 0; k < layers_.size(); ++k)
    layers += fmt::format("0\nLAYER\n2\n{}\n70\n0\n62\n{}\n6\nCONTINUOUS\n", layers_[k],
                          1 + static_cast<int>(k) % colours);
  return "999\nlengths in metres\n0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n"
         "0\nSECTION\n2\nTABLES\n"
         "0\nTABLE\n2\nLTYPE\n70\n1\n0\nLTYPE\n2\nCONTINUOUS\n70\n0\n3\nSolid "
         "line\n72\n65\n73\n0\n40\n0.0\n0\nENDTAB\n" +
         fmt::format("0\nTABLE\n2\nLAYER\n70\n{}\n", layers_.size()) + layers +
         "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities_ + "0\nENDSEC\n0\nEOF\n";
}

}  // namespace keyblock::drawing
