#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace keyblock::results {

/// Builds an XML file of VTK (https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html) whose arrays are
/// appended as raw bytes, little-endian as they lie in memory.
class VtkFile {
 public:
  /// `kind` is "UnstructuredGrid" or "PolyData".
  explicit VtkFile(std::string kind) : kind_(std::move(kind)) {}

  void open(const std::string& element, const std::string& attributes = {});
  void close(const std::string& element);
  /// A data array of `components` values per point, cell or tuple. `component_names` may be empty.
  template <class T>
  void array(const std::string& name, std::span<const T> values, int components = 1,
             const std::vector<std::string>& component_names = {});
  /// For the field data of the file: one value.
  template <class T>
  void field(const std::string& name, T value);
  /// The points of the piece, x, y, z of each, with a vertex at each.
  void points(const std::vector<double>& coordinates);
  [[nodiscard]] std::string text() const;

 private:
  void data_array(const char* type, const std::string& name, std::size_t tuples, int components,
                  const std::vector<std::string>& component_names, const void* bytes, std::size_t size);
  std::string kind_;
  std::string body_;
  std::string appended_;
};

/// Attributes of a piece of PolyData.
std::string vtk_piece(std::size_t points, std::size_t vertices, std::size_t lines);

/// A series of files over time (.pvd). Paths are relative to it.
std::string vtk_series(const std::vector<std::pair<double, std::string>>& files);

}  // namespace keyblock::results
