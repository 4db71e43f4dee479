#include "results/breaks.h"

#include <fmt/format.h>

#include <iterator>
#include <type_traits>

#include "core/checked_json.h"
#include "core/error.h"
#include "cutting/edge_name.h"
#include "results/block_shape.h"
#include "results/csv.h"
#include "results/vtk_parts.h"

namespace keyblock::results {

using nlohmann::ordered_json;

namespace {

/// The joint set, map, outline or element.
std::string name_of(const record::ModelRecord& model, cutting::EdgeLabel label, std::int32_t element) {
  if (element >= 0) return model.elements.at(static_cast<std::size_t>(element)).name;
  if (label.kind == cutting::EdgeKind::free) return "joints";  // as in the scenario
  return cutting::edge_name(label, model.joint_set_names, model.trace_map_names, model.excavation_names);
}

template <class Enum>
Enum read_name(const ordered_json& json, std::string (*name)(Enum)) {
  for (int k = 0; k <= static_cast<int>(last_of(Enum())); ++k)
    if (json == name(static_cast<Enum>(k))) return static_cast<Enum>(k);
  throw RunError(fmt::format("breaks hold the unknown name {}", json.dump()));
}

}  // namespace

ordered_json breaks_json(const std::vector<record::BreakCount>& counts, const record::ModelRecord* model) {
  ordered_json json = ordered_json::array();
  for (const record::BreakCount& count : counts) {
    ordered_json& row = json.emplace_back(ordered_json::object());
    if (model != nullptr) row["name"] = name_of(*model, {count.kind, count.index, -1}, count.element);
    row["mode"] = record::name_of(count.mode);
    row["edge_kind"] = edge_kind_name(count.kind);
    record::visit_count(count, [&](const char* name, const auto& value) { row[name] = value; });
  }
  return json;
}

std::vector<record::BreakCount> read_breaks(const ordered_json& json) {
  std::vector<record::BreakCount> counts;
  for (const ordered_json& row : json) {
    record::BreakCount& count = counts.emplace_back();
    count.mode = read_name<record::BreakMode>(row.at("mode"), record::name_of);
    count.kind = read_name<cutting::EdgeKind>(row.at("edge_kind"), edge_kind_name);
    record::visit_count(count, [&](const char* name, auto& value) { row.at(name).get_to(value); });
  }
  return counts;
}

std::string break_table(const RunData& data) {
  if (data.breaks.empty()) return {};
  std::string text;
  record::visit_fields(record::break_fields, [&]<class Row, class T>(const record::RowField<Row, T>& field) {
    if (!text.empty()) text += ',';
    text += std::is_same_v<T, Vec2> ? "x,y" : field.name;
  });
  text += ",name\n";
  auto out = std::back_inserter(text);
  const auto put = [&](const auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, Vec2>) {
      fmt::format_to(out, "{},{}", value.x + data.model.origin.x, value.y + data.model.origin.y);
    } else if constexpr (std::is_same_v<T, cutting::EdgeKind>) {
      text += edge_kind_name(value);
    } else if constexpr (std::is_same_v<T, record::BreakMode>) {
      text += record::name_of(value);
    } else {
      fmt::format_to(out, "{}", value);
    }
  };
  for (const record::BreakRecord& row : data.breaks) {
    record::visit_fields(record::break_fields, [&](const auto& field) {
      put(row.*field.member);
      text += ',';
    });
    text += csv_field(name_of(data.model, row.label(), row.element)) + "\n";
  }
  return text;
}

std::string vtk_breaks(const RunData& data) {
  std::vector<double> points;
  for (const record::BreakRecord& row : data.breaks)
    points.insert(points.end(), {row.position.x, row.position.y, 0.0});
  VtkFile file("PolyData");
  const record::BreakRecord last = data.breaks.empty() ? record::BreakRecord{} : data.breaks.back();
  add_vtk_moment(file, data.model, last.time, last.stage, last.step);
  file.open("Piece", vtk_piece(data.breaks.size(), data.breaks.size(), 0));
  file.open("PointData", "Scalars=\"mode\"");
  record::visit_fields(record::break_fields, [&]<class Row, class T>(const record::RowField<Row, T>& field) {
    if constexpr (!std::is_same_v<T, Vec2>) {
      using Number = std::conditional_t<std::is_floating_point_v<T>, double, std::int32_t>;
      std::vector<Number> column;
      for (const record::BreakRecord& row : data.breaks)
        column.push_back(static_cast<Number>(row.*field.member));
      file.array(field.name, view(column));
    }
  });
  file.close("PointData");
  file.points(points);
  file.close("Piece");
  return file.text();
}

}  // namespace keyblock::results
