#pragma once
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// A thin owner for each thing of the HDF5 C API, for the sources of this folder only (the header is heavy).
/// Every function throws RunError with HDF5's own words when a call fails, and those that read also when a file says that it holds more
/// than it can.
namespace keyblock::results::hdf5 {

/// Closes what it holds.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  // NOLINTNEXTLINE(google-explicit-constructor): a handle stands for its id in calls of the C API
  operator hid_t() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  herr_t (*close_)(hid_t) = nullptr;
};

/// Keeps HDF5 from printing its errors on standard error while it lives.
class QuietErrors {
 public:
  QuietErrors();
  ~QuietErrors();
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Throws RunError with `what` and the innermost message of HDF5 when `status` is negative.
void check(herr_t status, const std::string& what);
hid_t check_id(hid_t id, const std::string& what);

template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int16_t>) return H5T_NATIVE_INT16;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
}

/// What HDF5 has handed to the system stands on the disk when it returns.
void sync(hid_t file);
/// Nothing more of the file reaches the disk: it stays as a kill would leave it, and can be closed without a further error.
void detach(hid_t file);

Handle create_group(hid_t parent, const std::string& name);
Handle open_group(hid_t parent, const std::string& name);
Handle open_dataset(hid_t parent, const std::string& name);

/// A file that open(access properties) opens or creates, locked as far as the file system knows locks: HDF5 itself only
/// understands ENOSYS, where others say ENOLCK or EOPNOTSUPP.
Handle open_with_or_without_locks(const std::function<hid_t(hid_t)>& open);

/// Attributes of a group, UTF-8 strings and scalars. Lists of strings are as write_strings has them.
void write_attribute(hid_t object, const std::string& name, const std::string& value);
void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& values);
template <class T>
void write_attribute(hid_t object, const std::string& name, T value);
std::string read_text_attribute(hid_t object, const std::string& name);
template <class T>
T read_attribute(hid_t object, const std::string& name);

/// Datasets written once, with checksums. `shape` includes the number of rows.
template <class T>
void write_array(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                 std::span<const T> values);
/// Texts of any length each, for programs of others: netCDF falls over arrays of texts of one length. They lie in a heap without a checksum,
/// where one wrong byte lets the library fall: keyblock does not read them.
void write_strings(hid_t group, const std::string& name, const std::vector<std::string>& values);

/// Makes a dataset of one dimension a scale that others can have (HDF5 Dimension Scale Specification), by the name that netCDF shows.
void make_scale(hid_t dataset, const std::string& name);
/// Gives a dataset its scales, one for each dimension; empty paths: none for that one.
void attach_scales(hid_t file, hid_t dataset, const std::vector<std::string>& scales);

template <class T>
struct Array {
  std::vector<hsize_t> shape;
  std::vector<T> values;
  [[nodiscard]] std::size_t rows() const { return shape.empty() ? 0 : static_cast<std::size_t>(shape[0]); }
  /// Values per row.
  [[nodiscard]] std::size_t width() const {
    std::size_t n = 1;
    for (std::size_t k = 1; k < shape.size(); ++k) n *= static_cast<std::size_t>(shape[k]);
    return n;
  }
};
template <class T>
Array<T> read_array(hid_t group, const std::string& name);
/// Throws RunError unless every row is one value.
template <class T>
Array<T> read_column(hid_t group, const std::string& name);
std::vector<std::string> read_strings(hid_t group, const std::string& name);

/// A dataset that grows by rows, compressed and with checksums. Rows gather in memory until flush(). A row of doubles that was
/// made room for but not yet written, when the process is killed, reads as NaN.
template <class T>
class Column {
 public:
  Column() = default;
  /// `row_shape` are the dimensions after the first.
  Column(hid_t group, const std::string& name, std::vector<hsize_t> row_shape);
  /// One or more whole rows.
  void append(std::span<const T> rows) {
    buffer_.insert(buffer_.end(), rows.begin(), rows.end());
    pending_rows_ += row_size_ > 0 ? rows.size() / row_size_ : 0;
    if (buffer_.size() * sizeof(T) >= largest_buffer) write();
  }
  void append(T value) { append(std::span<const T>(&value, 1)); }
  /// A row of no values, for datasets whose rows are empty.
  void append_row(std::span<const T> row) {
    if (row_size_ == 0)
      ++pending_rows_;
    else
      append(row);
  }
  /// All rows so far stand in the file when it returns.
  void flush();
  [[nodiscard]] hsize_t rows() const { return rows_ + pending_rows_; }

 private:
  static constexpr std::size_t largest_buffer = std::size_t{1} << 20U;  // bytes
  void write();
  Handle dataset_;
  std::string name_;
  std::vector<hsize_t> row_shape_;
  std::size_t row_size_ = 1;
  hsize_t rows_ = 0, pending_rows_ = 0;
  std::vector<T> buffer_;
};

}  // namespace keyblock::results::hdf5
