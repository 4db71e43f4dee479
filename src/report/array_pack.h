#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::report {

/// Numeric arrays one after the other in one zlib stream, written as base64: what the page reads with
/// DecompressionStream('deflate'). Little-endian; every array starts at a multiple of 8 bytes.
class ArrayPack {
 public:
  struct Entry {
    std::string name;
    std::string type;    ///< as JavaScript's typed arrays have it: u8, u32, i32, f32, f64
    std::size_t offset;  ///< bytes from the start of the uncompressed stream
    std::size_t count;   ///< elements
  };

  void add(std::string_view name, std::span<const std::uint8_t> values);
  void add(std::string_view name, std::span<const std::uint32_t> values);
  void add(std::string_view name, std::span<const std::int32_t> values);
  void add(std::string_view name, std::span<const float> values);
  void add(std::string_view name, std::span<const double> values);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] std::string encoded() const;

 private:
  void append(std::string_view name, std::string_view type, std::span<const std::byte> bytes,
              std::size_t count);
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> bytes_;
};

/// Base64 with padding (RFC 4648).
std::string to_base64(std::span<const std::uint8_t> bytes);

}  // namespace keyblock::report
