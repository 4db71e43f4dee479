#include "results/vtk_file.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <type_traits>

namespace keyblock::results {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, float>) return "Float32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

}  // namespace

void VtkFile::open(const std::string& element, const std::string& attributes) {
  body_ += fmt::format("<{}{}{}>\n", element, attributes.empty() ? "" : " ", attributes);
}

void VtkFile::close(const std::string& element) {
  body_ += fmt::format("</{}>\n", element);
}

void VtkFile::data_array(const char* type, const std::string& name, std::size_t tuples, int components,
                         const std::vector<std::string>& component_names, const void* bytes,
                         std::size_t size) {
  std::string names;
  for (std::size_t k = 0; k < component_names.size(); ++k)
    names += fmt::format(" ComponentName{}=\"{}\"", k, component_names[k]);
  body_ += fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} NumberOfTuples=\"{}\" "
      "format=\"appended\" offset=\"{}\"/>\n",
      type, name, components, names, tuples, appended_.size());
  const std::uint64_t length = size;
  const std::size_t at = appended_.size();
  appended_.resize(at + sizeof length + size);
  std::memcpy(appended_.data() + at, &length, sizeof length);
  if (size > 0) std::memcpy(appended_.data() + at + sizeof length, bytes, size);
}

template <class T>
void VtkFile::array(const std::string& name, std::span<const T> values, int components,
                    const std::vector<std::string>& component_names) {
  data_array(vtk_type<T>(), name, values.size() / static_cast<std::size_t>(components), components,
             component_names, values.data(), values.size_bytes());
}

template <class T>
void VtkFile::field(const std::string& name, T value) {
  data_array(vtk_type<T>(), name, 1, 1, {}, &value, sizeof value);
}

void VtkFile::points(const std::vector<double>& coordinates) {
  std::vector<std::int64_t> vertices, end;
  for (std::int64_t k = 0; k < static_cast<std::int64_t>(coordinates.size() / 3); ++k) {
    vertices.push_back(k);
    end.push_back(k + 1);
  }
  open("Points");
  array("Points", std::span<const double>(coordinates), 3);
  close("Points");
  open("Verts");
  array("connectivity", std::span<const std::int64_t>(vertices));
  array("offsets", std::span<const std::int64_t>(end));
  close("Verts");
}

std::string VtkFile::text() const {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<{0}>\n{1}</{0}>\n"
      "<AppendedData encoding=\"raw\">\n_",
      kind_, body_);
  text += appended_;
  return text + "\n</AppendedData>\n</VTKFile>\n";
}

std::string vtk_piece(std::size_t points, std::size_t vertices, std::size_t lines) {
  return fmt::format(
      "NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\"",
      points, vertices, lines);
}

std::string vtk_series(const std::vector<std::pair<double, std::string>>& files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto& [time, file] : files) {
    text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, file);
  }
  return text + "</Collection>\n</VTKFile>\n";
}

template void VtkFile::array(const std::string&, std::span<const double>, int,
                             const std::vector<std::string>&);
template void VtkFile::array(const std::string&, std::span<const float>, int,
                             const std::vector<std::string>&);
template void VtkFile::array(const std::string&, std::span<const std::int64_t>, int,
                             const std::vector<std::string>&);
template void VtkFile::array(const std::string&, std::span<const std::int32_t>, int,
                             const std::vector<std::string>&);
template void VtkFile::array(const std::string&, std::span<const std::uint8_t>, int,
                             const std::vector<std::string>&);
template void VtkFile::field(const std::string&, double);
template void VtkFile::field(const std::string&, std::int32_t);
template void VtkFile::field(const std::string&, std::int64_t);

}  // namespace keyblock::results
