#include "results/vtk_parts.h"

namespace keyblock::results {

std::string vtk_elements(const record::ModelRecord& model, const record::Frame& frame) {
  std::vector<double> points;
  std::vector<double> numbers[std::size(record::element_state_fields)];
  std::vector<std::int64_t> vertices, end;
  std::vector<std::int32_t> number;
  for (std::size_t k = 0; k < frame.elements.size(); ++k) {
    const record::ElementState& e = frame.elements[k];
    if (!e.present) continue;
    for (const Vec2 p : {e.from, e.to}) {
      vertices.push_back(static_cast<std::int64_t>(vertices.size()));
      points.insert(points.end(), {p.x, p.y, 0.0});
    }
    end.push_back(static_cast<std::int64_t>(vertices.size()));
    number.push_back(static_cast<std::int32_t>(k));
    for (std::size_t n = 0; n < std::size(numbers); ++n)
      numbers[n].push_back(e.*record::element_state_fields[n].number);
  }
  VtkFile file("PolyData");
  add_vtk_moment(file, model, frame.time, frame.stage, frame.step);
  file.open("Piece", vtk_piece(vertices.size(), 0, end.size()));
  file.open("CellData", "Scalars=\"force\"");
  file.array("element", view(number));
  for (std::size_t n = 0; n < std::size(numbers); ++n)
    file.array(record::element_state_fields[n].name, view(numbers[n]));
  file.close("CellData");
  file.open("Points");
  file.array("Points", view(points), 3);
  file.close("Points");
  add_vtk_lines(file, vertices, end);
  file.close("Piece");
  return file.text();
}

}  // namespace keyblock::results
