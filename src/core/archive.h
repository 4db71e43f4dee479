#pragma once
#include <concepts>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/hash.h"

namespace keyblock {

/// Writes values one after the other as bytes of this machine, and their hash in the end: for checkpoints, read again by the
/// same program.
class ArchiveWriter {
 public:
  explicit ArchiveWriter(AtomicFile& file) : file_(file) {}

  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const T& value) { append(&value, sizeof(T)); }
  template <typename A, typename B>
  void operator()(const std::pair<A, B>& pair) {
    (*this)(pair.first);
    (*this)(pair.second);
  }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }
  template <typename T>
  void operator()(const std::vector<T>& values) {
    (*this)(static_cast<std::uint64_t>(values.size()));
    for (const T& value : values) (*this)(value);
  }
  /// The hash of all before it; nothing may follow.
  void finish() {
    flush();
    (*this)(hash_.value());
    flush();
  }

 private:
  static constexpr std::size_t piece = 1 << 16;  ///< bytes kept before they are written
  void append(const void* bytes, std::size_t size) {
    buffer_.append(static_cast<const char*>(bytes), size);
    if (buffer_.size() >= piece) flush();
  }
  void flush() {
    hash_.add(buffer_.data(), buffer_.size());
    file_.write(buffer_);
    buffer_.clear();
  }

  AtomicFile& file_;
  Hash hash_;
  std::string buffer_;
};

/// The data end before what they say they hold, or hold what no value is.
class ArchiveError : public std::runtime_error {
 public:
  ArchiveError() : std::runtime_error("archive") {}
};

/// Reads what ArchiveWriter wrote, or anybody else: no more memory is asked for than the data fill. Throws ArchiveError. Values are
/// bytes as they stand there; only that bools and optionals are such is seen to.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view data) : data_(data) {}
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(T& value) { std::memcpy(&value, take(sizeof(T)), sizeof(T)); }
  void operator()(bool& value) { value = flag(*take(1)); }
  /// Whether there is a value stands behind it.
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::optional<T>& value) {
    const char* bytes = take(sizeof(value));
    flag(bytes[sizeof(T)]);
    std::memcpy(&value, bytes, sizeof(value));
  }
  template <typename A, typename B>
  void operator()(std::pair<A, B>& pair) {
    (*this)(pair.first);
    (*this)(pair.second);
  }
  void operator()(std::string& text) {
    const std::size_t size = read_size(1);
    text.assign(take(size), size);
  }
  template <typename T>
  void operator()(std::vector<T>& values) {
    values.resize(read_size(sizeof(T)));
    for (T& value : values) (*this)(value);
  }
  [[nodiscard]] bool at_end() const { return data_.empty(); }

 private:
  static bool flag(char byte) {
    if (static_cast<unsigned char>(byte) > 1) throw ArchiveError();
    return byte != 0;
  }
  /// Of things that take so many bytes each.
  std::size_t read_size(std::size_t bytes) {
    std::uint64_t size = 0;
    (*this)(size);
    if (size > data_.size() / bytes) throw ArchiveError();
    return size;
  }
  const char* take(std::size_t size) {
    if (size > data_.size()) throw ArchiveError();
    const char* start = data_.data();
    data_.remove_prefix(size);
    return start;
  }
  std::string_view data_;
};

}  // namespace keyblock
