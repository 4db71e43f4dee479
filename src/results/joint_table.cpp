#include "results/joint_table.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <type_traits>

#include "core/checked_json.h"
#include "core/error.h"
#include "cutting/edge_name.h"
#include "results/block_shape.h"
#include "results/csv.h"
#include "results/hdf5_file.h"
#include "results/json_parts.h"
#include "results/table_rows.h"

namespace keyblock::results {

using hdf5::read_column;
using hdf5::write_array;
using nlohmann::ordered_json;

void write_joints(hid_t file, const record::ModelRecord& model) {
  const std::size_t count = model.joints.size();
  if (count == 0) return;
  std::vector<std::uint8_t> kind;
  std::vector<std::int16_t> index;
  std::vector<std::int32_t> trace;
  for (const record::JointRecord& joint : model.joints) {
    kind.push_back(static_cast<std::uint8_t>(joint.label.kind));
    index.push_back(joint.label.index);
    trace.push_back(joint.label.trace);
  }
  const hdf5::Handle group = hdf5::create_group(file, "joints");
  write_array<std::uint8_t>(group, "edge_kind", {count}, kind);
  write_array<std::int16_t>(group, "edge_index", {count}, index);
  write_array<std::int32_t>(group, "trace", {count}, trace);
  for (const record::JointField& field : record::joint_fields) {
    std::vector<double> column;
    for (const record::JointRecord& joint : model.joints) column.push_back(joint.*field.number);
    write_array<double>(group, field.name, {count}, column);
  }
}

void read_joints(hid_t file, record::ModelRecord& model) {
  if (H5Lexists(file, "joints", H5P_DEFAULT) <= 0) return;
  const hdf5::Handle group = hdf5::open_group(file, "joints");
  const auto kind = read_column<std::uint8_t>(group, "edge_kind");
  const auto index = read_column<std::int16_t>(group, "edge_index");
  const auto trace = read_column<std::int32_t>(group, "trace");
  require(index.rows() == kind.rows() && trace.rows() == kind.rows(), "joints");
  for (std::size_t k = 0; k < kind.rows(); ++k) {
    record::JointRecord& joint = model.joints.emplace_back();
    joint.label = {enumerator(kind.values[k], cutting::EdgeKind::domain, "joints/edge_kind"), index.values[k],
                   trace.values[k]};
  }
  for (const record::JointField& field : record::joint_fields) {
    const auto column = read_column<double>(group, field.name);
    require(column.rows() == kind.rows(), "joints");
    for (std::size_t k = 0; k < column.rows(); ++k) model.joints[k].*field.number = column.values[k];
  }
}

std::vector<record::DrawnStrength> read_strengths(const ordered_json& json) {
  std::vector<record::DrawnStrength> strengths;
  for (const ordered_json& row : json) {
    visit_strength(strengths.emplace_back(), [&](const char* name, auto& value) {
      if constexpr (std::is_same_v<decltype(value), double&>) {
        value = number(row.at(name));
      } else {
        row.at(name).get_to(value);
      }
    });
  }
  return strengths;
}

std::string joint_table(const record::ModelRecord& model) {
  if (model.joints.empty()) return {};
  std::string text = "joint,name,trace";
  for (const record::JointField& field : record::joint_fields) text += fmt::format(",{}", field.name);
  text += "\n";
  auto out = std::back_inserter(text);
  for (const record::JointRecord& joint : model.joints) {
    const std::string name =
        cutting::edge_name(joint.label, model.joint_set_names, model.trace_map_names, model.excavation_names);
    fmt::format_to(out, "{},{},", edge_kind_name(joint.label.kind), csv_field(name));
    if (joint.label.trace >= 0) fmt::format_to(out, "{}", joint.label.trace);
    for (const record::JointField& field : record::joint_fields) {
      text += ',';
      if (const double number = joint.*field.number; !std::isnan(number)) fmt::format_to(out, "{}", number);
    }
    text += "\n";
  }
  return text;
}

}  // namespace keyblock::results
