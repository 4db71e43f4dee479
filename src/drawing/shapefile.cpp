#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "drawing/drawing.h"
#include "drawing/refuse.h"

namespace keyblock::drawing {
namespace {

constexpr std::size_t header_bytes = 100, record_header_bytes = 8, bytes_of_word = 2;
// Within a record: its type, its box, the numbers of parts and points.
constexpr std::size_t parts_at = 44, type_bytes = 4;

// Numbers of a text, at places that are checked before.
class Bytes {
 public:
  explicit Bytes(std::string_view text) : text_(text) {}
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  [[nodiscard]] std::uint32_t big(std::size_t at) const { return whole(at, {24, 16, 8, 0}); }
  [[nodiscard]] std::uint32_t little(std::size_t at) const { return whole(at, {0, 8, 16, 24}); }
  [[nodiscard]] double real(std::size_t at) const {
    const std::uint64_t bits = little(at) | (static_cast<std::uint64_t>(little(at + 4)) << 32U);
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  [[nodiscard]] Bytes part(std::size_t at, std::size_t bytes) const { return Bytes(text_.substr(at, bytes)); }

 private:
  [[nodiscard]] std::uint32_t whole(std::size_t at, const std::array<unsigned, 4>& shifts) const {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(text_[at + k])) << shifts[k];
    return value;
  }
  std::string_view text_;
};

enum class ShapeKind { none, line, polygon, other };

// Those with Z and M have the numbers of the plain ones and 10 or 20 more.
ShapeKind kind_of(std::uint32_t type) {
  if (type == 0) return ShapeKind::none;
  if (type == 3 || type == 13 || type == 23) return ShapeKind::line;
  return type == 5 || type == 15 || type == 25 ? ShapeKind::polygon : ShapeKind::other;
}

class ShapefileReader {
 public:
  ShapefileReader(std::string_view text, const std::string& file) : bytes_(text), file_(file) {
    drawing_.file = file;
    drawing_.unit = 1.0;  // m, of a projected system
  }

  Drawing read() {
    for (std::size_t at = header_bytes; at < bytes_.size();) {
      ++record_;
      if (bytes_.size() - at < record_header_bytes) fail("the end of the file", "the header of a record");
      const std::size_t length = bytes_of_word * static_cast<std::size_t>(bytes_.big(at + 4));
      at += record_header_bytes;
      if (length < type_bytes || length > bytes_.size() - at)
        fail(fmt::format("a record of {} bytes", length),
             fmt::format("{} to {}, which the file has left", type_bytes, bytes_.size() - at));
      shape(bytes_.part(at, length));
      at += length;
    }
    return std::move(drawing_);
  }

 private:
  [[noreturn]] void fail(std::string found, std::string expected) const {
    refuse(file_, 0, fmt::format("record {}", record_), std::move(found), std::move(expected));
  }

  void shape(const Bytes& record) {
    const ShapeKind kind = kind_of(record.little(0));
    if (kind == ShapeKind::none) return;
    if (kind == ShapeKind::other) {
      if (drawing_.skipped.empty()) drawing_.skipped.push_back({"shapes that are no lines", "", 0, record_});
      ++drawing_.skipped.front().count;
      return;
    }
    if (record.size() < parts_at) fail("its end", "the numbers of its parts and points");
    const std::size_t parts = record.little(36), points = record.little(40);
    constexpr std::size_t bytes_of_part = 4, bytes_of_point = 16;
    if (parts > record.size() || points > record.size() ||
        parts_at + parts * bytes_of_part + points * bytes_of_point > record.size())
      fail(fmt::format("{} parts of {} points", parts, points), "as many as the record has place for");
    const std::size_t points_at = parts_at + parts * bytes_of_part;
    for (std::size_t k = 0; k < parts; ++k) {
      const std::size_t begin = record.little(parts_at + k * bytes_of_part);
      const std::size_t end = k + 1 < parts ? record.little(parts_at + (k + 1) * bytes_of_part) : points;
      if (begin > end || end > points)
        fail(fmt::format("a part from point {} to {}", begin, end), "parts one after the other");
      DrawnLine line{
          {}, kind == ShapeKind::polygon, "", kind == ShapeKind::polygon ? "Polygon" : "PolyLine", record_};
      for (std::size_t p = begin; p < end; ++p) add_vertex(record, points_at + p * bytes_of_point, line);
      close(line);
      drawing_.lines.push_back(std::move(line));
    }
  }

  void add_vertex(const Bytes& record, std::size_t at, DrawnLine& line) const {
    const Vec2 p{record.real(at), record.real(at + 8)};
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) fail("a coordinate that is no number", "finite numbers");
    if (line.vertices.empty() || !(p == line.vertices.back())) line.vertices.push_back(p);
  }

  static void close(DrawnLine& line) {
    if (line.vertices.size() > 3 && line.vertices.front() == line.vertices.back()) {
      line.closed = true;
      line.vertices.pop_back();
    }
  }

  Bytes bytes_;
  const std::string& file_;
  Drawing drawing_;
  int record_ = 0;
};

}  // namespace

bool is_shapefile(std::string_view text) {
  using std::string_view_literals::operator""sv;
  return text.starts_with("\0\0\x27\x0a"sv);
}

Drawing read_shapefile(std::string_view text, const std::string& file) {
  if (text.size() < header_bytes)
    refuse(file, 0, "", fmt::format("{} bytes", text.size()),
           fmt::format("a shapefile, whose header alone has {}", header_bytes));
  return ShapefileReader(text, file).read();
}

}  // namespace keyblock::drawing
