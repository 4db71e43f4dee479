#pragma once
#include <concepts>
#include <cstdint>
#include <cstring>
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

/// Reads what ArchiveWriter wrote. Throws std::out_of_range at a premature end.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view data) : data_(data) {}
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(T& value) { std::memcpy(&value, take(sizeof(T)), sizeof(T)); }
  template <typename A, typename B>
  void operator()(std::pair<A, B>& pair) {
    (*this)(pair.first);
    (*this)(pair.second);
  }
  void operator()(std::string& text) {
    const std::size_t size = read_size();
    text.assign(take(size), size);
  }
  template <typename T>
  void operator()(std::vector<T>& values) {
    const std::size_t size = read_size();
    if (size > data_.size()) throw std::out_of_range("archive");
    values.resize(size);
    for (T& value : values) (*this)(value);
  }

 private:
  std::size_t read_size() {
    std::uint64_t size = 0;
    (*this)(size);
    return size;
  }
  const char* take(std::size_t size) {
    if (size > data_.size()) throw std::out_of_range("archive");
    const char* start = data_.data();
    data_.remove_prefix(size);
    return start;
  }
  std::string_view data_;
};

}  // namespace keyblock
