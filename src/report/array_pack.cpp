#include "report/array_pack.h"

#include <zlib.h>

#include <bit>
#include <stdexcept>

namespace keyblock::report {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian arrays");

void ArrayPack::append(std::string_view name, std::string_view type, std::span<const std::byte> bytes,
                       std::size_t count) {
  constexpr std::size_t alignment = 8;
  bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment);
  entries_.push_back({std::string(name), std::string(type), bytes_.size(), count});
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  bytes_.insert(bytes_.end(), begin, begin + bytes.size());
}

void ArrayPack::add(std::string_view name, std::span<const std::uint8_t> values) {
  append(name, "u8", std::as_bytes(values), values.size());
}
void ArrayPack::add(std::string_view name, std::span<const std::uint32_t> values) {
  append(name, "u32", std::as_bytes(values), values.size());
}
void ArrayPack::add(std::string_view name, std::span<const std::int32_t> values) {
  append(name, "i32", std::as_bytes(values), values.size());
}
void ArrayPack::add(std::string_view name, std::span<const float> values) {
  append(name, "f32", std::as_bytes(values), values.size());
}
void ArrayPack::add(std::string_view name, std::span<const double> values) {
  append(name, "f64", std::as_bytes(values), values.size());
}

std::string ArrayPack::encoded() const {
  uLongf size = compressBound(bytes_.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes_.data(), bytes_.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::logic_error("zlib: compress2 failed");
  packed.resize(size);
  return to_base64(packed);
}

std::string to_base64(std::span<const std::uint8_t> bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? digits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

}  // namespace keyblock::report
