#include "results/hdf5_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <string_view>

#include "core/error.h"

namespace keyblock::results::hdf5 {
namespace {

constexpr unsigned deflate_level = 1;
// Chunks hold whole rows, about this many bytes of them.
constexpr std::size_t chunk_bytes = 65536;
constexpr hsize_t largest_file = hsize_t{1} << 50U;  // bytes

// The first message from the inside, the cause: "unable to extend file: No space left on device".
herr_t keep_message(unsigned n, const H5E_error2_t* error, void* text) {
  if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

// "file write failed: time = …, error message = 'No space left on device', buf = …" without what only programmers ask for.
std::string shortened(std::string cause) {
  constexpr std::string_view before = "error message = '";
  const std::size_t begin = cause.find(before), first = cause.find(": time = ");
  if (begin == std::string::npos || first == std::string::npos) return cause;
  const std::size_t message = begin + before.size();
  return cause.substr(0, first) + ": " + cause.substr(message, cause.find('\'', message) - message);
}

hsize_t product(const std::vector<hsize_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

// Texts of up to `size` bytes, padded by zeros.
Handle string_type(std::size_t size) {
  Handle type(check_id(H5Tcopy(H5T_C_S1), "string type"), H5Tclose);
  check(H5Tset_size(type, std::max<std::size_t>(size, 1)), "string type");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "string type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "string type");
  return type;
}

Handle type_of_any_length() {
  Handle type(check_id(H5Tcopy(H5T_C_S1), "string type"), H5Tclose);
  check(H5Tset_size(type, H5T_VARIABLE), "string type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "string type");
  return type;
}

std::vector<const char*> pointers_to(const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  return pointers;
}

// A text that ends with a zero, as the specification of dimension scales asks for.
void write_plain_text(hid_t object, const char* name, const std::string& value) {
  const Handle type(check_id(H5Tcopy(H5T_C_S1), name), H5Tclose);
  check(H5Tset_size(type, value.size() + 1), name);
  check(H5Tset_strpad(type, H5T_STR_NULLTERM), name);
  const Handle space(check_id(H5Screate(H5S_SCALAR), name), H5Sclose);
  const Handle attribute(check_id(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), name),
                         H5Aclose);
  check(H5Awrite(attribute, type, value.c_str()), name);
}

// "unable to lock file, errno = 37, …", except for a file that is in use.
herr_t see_failed_lock(unsigned /*n*/, const H5E_error2_t* error, void* seen) {
  const std::string_view text = error->desc == nullptr ? "" : error->desc;
  if (text.find("unable to lock file") != std::string_view::npos &&
      text.find(fmt::format("errno = {},", EAGAIN)) == std::string_view::npos)
    *static_cast<bool*>(seen) = true;
  return 0;
}

// The type of texts that are read, which must be such.
Handle string_type_of(hid_t stored, const std::string& name) {
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) != 0)
    throw RunError(name + " is no text of a fixed length");
  return string_type(H5Tget_size(stored));
}

std::string without_padding(std::string_view text) {
  return std::string(text.substr(0, text.find('\0')));
}

// Times of creation would make two files of one run differ.
Handle dataset_properties() {
  Handle properties(check_id(H5Pcreate(H5P_DATASET_CREATE), "dataset"), H5Pclose);
  check(H5Pset_obj_track_times(properties, false), "dataset");
  return properties;
}

// Chunks with checksums: damage shows when they are read.
void set_chunks(hid_t properties, const std::vector<hsize_t>& chunk, bool compressed) {
  check(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()), "chunks");
  if (compressed) {
    check(H5Pset_shuffle(properties), "compression");
    check(H5Pset_deflate(properties, deflate_level), "compression");
  }
  check(H5Pset_fletcher32(properties), "checksums");
}

std::vector<hsize_t> chunk_of(const std::vector<hsize_t>& row_shape, std::size_t value_bytes) {
  std::vector<hsize_t> chunk{1};
  for (const hsize_t n : row_shape) chunk.push_back(std::max<hsize_t>(n, 1));
  chunk[0] = std::clamp<hsize_t>(chunk_bytes / (product(chunk) * value_bytes), 1, 4096);
  return chunk;
}

template <class T>
hid_t file_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<T, float>) return H5T_IEEE_F32LE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::is_same_v<T, std::int16_t>) return H5T_STD_I16LE;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_STD_U8LE;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_STD_U64LE;
}

// How many values a dataset has: no more than what stands in the file can be unpacked to, and the rows that a run which was killed
// had made room for. Sizes that somebody has made up would ask for memory that nothing fills.
std::size_t count_of(hid_t dataset, const std::vector<hsize_t>& shape, std::size_t value_bytes,
                     const std::string& name) {
  constexpr hsize_t best_compression = 1100, made_room_for = hsize_t{1} << 26U;
  const hsize_t stored = std::min<hsize_t>(H5Dget_storage_size(dataset), largest_file);
  const hsize_t most = (stored * best_compression + made_room_for) / value_bytes;
  hsize_t count = 1;
  for (const hsize_t n : shape) {
    if (n != 0 && count > most / n) throw RunError(name + " is larger than what stands in the file");
    count *= n;
  }
  return static_cast<std::size_t>(count);
}

// Of a file of the default driver.
int descriptor_of(hid_t file) {
  void* descriptor = nullptr;
  check(H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor), "file descriptor");
  return *static_cast<int*>(descriptor);
}

}  // namespace

// Files are closed where their handles end. At the end of the program the library would try once more what could not be written
// to a full disk, and fall. Before any other call.
[[maybe_unused]] static const bool without_cleanup_at_exit = H5dont_atexit() >= 0;

QuietErrors::QuietErrors() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietErrors::~QuietErrors() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

void check(herr_t status, const std::string& what) {
  if (status >= 0) return;
  std::string cause;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_message, &cause);
  throw RunError(cause.empty() ? what : fmt::format("{}: {}", what, shortened(std::move(cause))));
}

hid_t check_id(hid_t id, const std::string& what) {
  check(id < 0 ? -1 : 0, what);
  return id;
}

void sync(hid_t file) {
  if (::fsync(descriptor_of(file)) != 0) throw RunError(std::strerror(errno));
}

void detach(hid_t file) {
  const int descriptor = descriptor_of(file), nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, descriptor);
  ::close(nowhere);
}

Handle create_group(hid_t parent, const std::string& name) {
  const Handle properties(check_id(H5Pcreate(H5P_GROUP_CREATE), name), H5Pclose);
  check(H5Pset_obj_track_times(properties, false), name);
  return {check_id(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), name), H5Gclose};
}

Handle open_dataset(hid_t parent, const std::string& name) {
  return {check_id(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), name), H5Dclose};
}

Handle open_with_or_without_locks(const std::function<hid_t(hid_t)>& open) {
  const char* const what = "file access";
  const Handle access(check_id(H5Pcreate(H5P_FILE_ACCESS), what), H5Pclose);
  check(H5Pset_file_locking(access, true, true), what);
  hid_t file = open(access);
  bool has_no_locks = false;
  if (file < 0) H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, see_failed_lock, &has_no_locks);
  if (has_no_locks) {
    check(H5Pset_file_locking(access, false, true), what);
    file = open(access);
  }
  return {check_id(file, "file"), H5Fclose};
}

Handle open_group(hid_t parent, const std::string& name) {
  return {check_id(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), name), H5Gclose};
}

void write_attribute(hid_t object, const std::string& name, const std::string& value) {
  const Handle type = string_type(value.size());
  const Handle space(check_id(H5Screate(H5S_SCALAR), name), H5Sclose);
  const Handle attribute(
      check_id(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), name), H5Aclose);
  check(H5Awrite(attribute, type, value.c_str()), name);
}

void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& values) {
  const Handle type = type_of_any_length();
  const hsize_t count = values.size();
  const Handle space(check_id(H5Screate_simple(1, &count, nullptr), name), H5Sclose);
  const Handle attribute(
      check_id(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), name), H5Aclose);
  check(H5Awrite(attribute, type, pointers_to(values).data()), name);
}

template <class T>
void write_attribute(hid_t object, const std::string& name, T value) {
  const Handle space(check_id(H5Screate(H5S_SCALAR), name), H5Sclose);
  const Handle attribute(
      check_id(H5Acreate2(object, name.c_str(), file_type<T>(), space, H5P_DEFAULT, H5P_DEFAULT), name),
      H5Aclose);
  check(H5Awrite(attribute, native_type<T>(), &value), name);
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  const Handle attribute(check_id(H5Aopen(object, name.c_str(), H5P_DEFAULT), name), H5Aclose);
  const Handle stored(check_id(H5Aget_type(attribute), name), H5Tclose);
  const Handle space(check_id(H5Aget_space(attribute), name), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) throw RunError(name + " is not one text");
  const Handle type = string_type_of(stored, name);
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), name);
  return without_padding(text);
}

template <class T>
T read_attribute(hid_t object, const std::string& name) {
  const Handle attribute(check_id(H5Aopen(object, name.c_str(), H5P_DEFAULT), name), H5Aclose);
  T value{};
  check(H5Aread(attribute, native_type<T>(), &value), name);
  return value;
}

template <class T>
void write_array(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                 std::span<const T> values) {
  const Handle space(check_id(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), name),
                     H5Sclose);
  const Handle properties = dataset_properties();
  constexpr std::size_t smallest_compressed = 4096;
  if (!values.empty()) set_chunks(properties, shape, values.size_bytes() >= smallest_compressed);
  const Handle dataset(
      check_id(H5Dcreate2(group, name.c_str(), file_type<T>(), space, H5P_DEFAULT, properties, H5P_DEFAULT),
               name),
      H5Dclose);
  if (!values.empty())
    check(H5Dwrite(dataset, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

void write_strings(hid_t group, const std::string& name, const std::vector<std::string>& values) {
  const hsize_t count = values.size();
  const Handle type = type_of_any_length();
  const Handle space(check_id(H5Screate_simple(1, &count, nullptr), name), H5Sclose);
  const Handle properties = dataset_properties();
  const Handle dataset(
      check_id(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), name),
      H5Dclose);
  if (count > 0)
    check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers_to(values).data()), name);
}

void make_scale(hid_t dataset, const std::string& name) {
  write_plain_text(dataset, "CLASS", "DIMENSION_SCALE");
  write_plain_text(dataset, "NAME", name);
}

void attach_scales(hid_t file, hid_t dataset, const std::vector<std::string>& scales) {
  const char* const what = "DIMENSION_LIST";
  std::vector<hobj_ref_t> references(scales.size());
  std::vector<hvl_t> lists(scales.size());
  for (std::size_t k = 0; k < scales.size(); ++k) {
    lists[k] = {0, nullptr};
    if (scales[k].empty()) continue;
    check(H5Rcreate(&references[k], file, scales[k].c_str(), H5R_OBJECT, -1), what);
    lists[k] = {1, &references[k]};
  }
  const Handle type(check_id(H5Tvlen_create(H5T_STD_REF_OBJ), what), H5Tclose);
  const hsize_t rank = scales.size();
  const Handle space(check_id(H5Screate_simple(1, &rank, nullptr), what), H5Sclose);
  const Handle attribute(check_id(H5Acreate2(dataset, what, type, space, H5P_DEFAULT, H5P_DEFAULT), what),
                         H5Aclose);
  check(H5Awrite(attribute, type, lists.data()), what);
}

template <class T>
Array<T> read_array(hid_t group, const std::string& name) {
  const Handle dataset(check_id(H5Dopen2(group, name.c_str(), H5P_DEFAULT), name), H5Dclose);
  const Handle space(check_id(H5Dget_space(dataset), name), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  check(rank, name);
  Array<T> array;
  array.shape.resize(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space, array.shape.data(), nullptr), name);
  array.values.resize(count_of(dataset, array.shape, sizeof(T), name));
  if (!array.values.empty()) {
    check(H5Dread(dataset, native_type<T>(), H5S_ALL, space, H5P_DEFAULT, array.values.data()), name);
  }
  return array;
}

template <class T>
Array<T> read_column(hid_t group, const std::string& name) {
  Array<T> array = read_array<T>(group, name);
  if (array.shape.size() != 1) throw RunError(name + " is no list of numbers");
  return array;
}

std::vector<std::string> read_strings(hid_t group, const std::string& name) {
  const Handle dataset(check_id(H5Dopen2(group, name.c_str(), H5P_DEFAULT), name), H5Dclose);
  const Handle space(check_id(H5Dget_space(dataset), name), H5Sclose);
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  check(points < 0 ? -1 : 0, name);
  const Handle stored(check_id(H5Dget_type(dataset), name), H5Tclose);
  const Handle type = string_type_of(stored, name);
  const auto count = static_cast<std::size_t>(points);
  const std::size_t size = H5Tget_size(type);
  std::string texts(count_of(dataset, {count, size}, 1, name), '\0');
  if (count > 0) check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), name);
  std::vector<std::string> values;
  for (std::size_t k = 0; k < count; ++k)
    values.push_back(without_padding(std::string_view(texts).substr(k * size, size)));
  return values;
}

template <class T>
Column<T>::Column(hid_t group, const std::string& name, std::vector<hsize_t> row_shape)
    : name_(name),
      row_shape_(std::move(row_shape)),
      row_size_(static_cast<std::size_t>(product(row_shape_))) {
  std::vector<hsize_t> now{0}, most{H5S_UNLIMITED};
  now.insert(now.end(), row_shape_.begin(), row_shape_.end());
  most.insert(most.end(), row_shape_.begin(), row_shape_.end());
  const Handle space(check_id(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), name),
                     H5Sclose);
  const Handle properties = dataset_properties();
  set_chunks(properties, chunk_of(row_shape_, sizeof(T)), true);
  if constexpr (std::is_same_v<T, double>) {
    const double unwritten = std::numeric_limits<double>::quiet_NaN();
    check(H5Pset_fill_value(properties, H5T_NATIVE_DOUBLE, &unwritten), name);
  }
  dataset_ = Handle(
      check_id(H5Dcreate2(group, name.c_str(), file_type<T>(), space, H5P_DEFAULT, properties, H5P_DEFAULT),
               name),
      H5Dclose);
}

template <class T>
void Column<T>::write() {
  if (pending_rows_ == 0) return;
  std::vector<hsize_t> extent{rows_ + pending_rows_}, start{rows_}, count{pending_rows_};
  for (const hsize_t n : row_shape_) {
    extent.push_back(n);
    start.push_back(0);
    count.push_back(n);
  }
  check(H5Dset_extent(dataset_, extent.data()), name_);
  if (!buffer_.empty()) {
    const Handle in_file(check_id(H5Dget_space(dataset_), name_), H5Sclose);
    check(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), name_);
    const Handle in_memory(
        check_id(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), name_), H5Sclose);
    check(H5Dwrite(dataset_, native_type<T>(), in_memory, in_file, H5P_DEFAULT, buffer_.data()), name_);
  }
  rows_ += pending_rows_;
  pending_rows_ = 0;
  buffer_.clear();
}

template <class T>
void Column<T>::flush() {
  if (!dataset_.valid()) return;
  write();
  check(H5Dflush(dataset_), name_);
}

template class Column<double>;
template class Column<float>;
template class Column<std::int64_t>;
template class Column<std::int32_t>;
template class Column<std::int16_t>;
template class Column<std::uint8_t>;

template void write_attribute(hid_t, const std::string&, double);
template void write_attribute(hid_t, const std::string&, std::int32_t);
template void write_attribute(hid_t, const std::string&, std::int64_t);
template void write_attribute(hid_t, const std::string&, std::uint64_t);
template double read_attribute(hid_t, const std::string&);
template std::int32_t read_attribute(hid_t, const std::string&);
template std::int64_t read_attribute(hid_t, const std::string&);
template std::uint64_t read_attribute(hid_t, const std::string&);

template void write_array(hid_t, const std::string&, const std::vector<hsize_t>&, std::span<const double>);
template void write_array(hid_t, const std::string&, const std::vector<hsize_t>&,
                          std::span<const std::int32_t>);
template void write_array(hid_t, const std::string&, const std::vector<hsize_t>&,
                          std::span<const std::int16_t>);
template void write_array(hid_t, const std::string&, const std::vector<hsize_t>&,
                          std::span<const std::uint8_t>);
template Array<double> read_array(hid_t, const std::string&);
template Array<double> read_column(hid_t, const std::string&);
template Array<float> read_array(hid_t, const std::string&);
template Array<float> read_column(hid_t, const std::string&);
template Array<std::int64_t> read_array(hid_t, const std::string&);
template Array<std::int64_t> read_column(hid_t, const std::string&);
template Array<std::int32_t> read_array(hid_t, const std::string&);
template Array<std::int32_t> read_column(hid_t, const std::string&);
template Array<std::int16_t> read_array(hid_t, const std::string&);
template Array<std::int16_t> read_column(hid_t, const std::string&);
template Array<std::uint8_t> read_array(hid_t, const std::string&);
template Array<std::uint8_t> read_column(hid_t, const std::string&);

}  // namespace keyblock::results::hdf5
