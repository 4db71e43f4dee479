#include "results/export.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "core/checked_json.h"
#include "cutting/edge_name.h"
#include "record/contact_fields.h"
#include "record/record_fields.h"
#include "results/block_shape.h"
#include "results/breaks.h"
#include "results/csv.h"
#include "results/elements_json.h"
#include "results/export_folder.h"
#include "results/joint_table.h"
#include "results/stage_ends.h"

namespace keyblock::results {
namespace {

using nlohmann::ordered_json;

constexpr std::pair<ExportFormat, std::string_view> formats[] = {{ExportFormat::vtk, "vtk"},
                                                                 {ExportFormat::csv, "csv"},
                                                                 {ExportFormat::geojson, "geojson"},
                                                                 {ExportFormat::dxf, "dxf"}};

std::string format_name(ExportFormat wanted) {
  for (const auto& [format, name] : formats) {
    if (format == wanted) return std::string(name);
  }
  return {};
}

std::string block_table(const RunData& data) {
  const record::ModelRecord& model = data.model;
  std::string text = "frame,time,stage,step,block,name,status,x,y,ux,uy,sxx,syy,sxy\n";
  auto out = std::back_inserter(text);
  std::vector<Vec2> reference;
  for (const auto& block : model.blocks) reference.push_back(model.origin + block.centroid);
  for (std::size_t f = 0; f < data.frames.size(); ++f) {
    const record::Frame& frame = data.frames[f];
    for (std::size_t b = 0; b < model.blocks.size(); ++b) {
      if (frame.status[b] == record::BlockStatus::excavated) continue;
      const Vec2 u = block_displacement(model, frame, b), x = reference[b] + u;
      const auto& s = frame.stress[b];
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", f, frame.time, frame.stage,
                     frame.step, b, csv_field(model.blocks[b].name), status_name(frame.status[b]), x.x, x.y,
                     u.x, u.y, s[0], s[1], s[2]);
    }
  }
  return text;
}

std::string edge_name(const record::ModelRecord& model, cutting::EdgeLabel label) {
  return cutting::edge_name(label, model.joint_set_names, model.trace_map_names, model.excavation_names);
}

std::string contact_table(const RunData& data) {
  std::string text = "time,stage,step,block_a,block_b,state,x,y,nx,ny";
  for (const record::ContactField& field : record::contact_fields) text += fmt::format(",{}", field.name);
  text += ",edge,edge_name\n";
  auto out = std::back_inserter(text);
  for (const record::ContactFrame& frame : data.contacts) {
    for (const record::ContactRecord& c : frame.contacts) {
      const Vec2 p = data.model.origin + c.position;
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{}", frame.time, frame.stage, frame.step, c.block_a,
                     c.block_b, contact_state_name(c.state), p.x, p.y, c.normal.x, c.normal.y);
      for (const record::ContactField& field : record::contact_fields) {
        text += ',';
        if (const double number = field.of(c); !std::isnan(number)) fmt::format_to(out, "{}", number);
      }
      fmt::format_to(out, ",{},{}\n", edge_kind_name(c.label.kind),
                     csv_field(edge_name(data.model, c.label)));
    }
  }
  return text;
}

std::string step_table(const RunData& data) {
  std::string text;
  record::visit_fields(record::step_fields, [&](const auto& field) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", field.name);
  });
  for (const record::EnergyField& field : record::energy_fields) text += fmt::format(",{}", field.name);
  text += "\n";
  auto out = std::back_inserter(text);
  for (const record::StepRow& r : data.steps) {
    const char* comma = "";
    record::visit_fields(record::step_fields, [&](const auto& field) {
      fmt::format_to(out, "{}{}", comma, r.*field.member);
      comma = ",";
    });
    for (const record::EnergyField& field : record::energy_fields)
      fmt::format_to(out, ",{}", r.energy.*field.number);
    text += "\n";
  }
  return text;
}

/// Empty where no excavation was opened in parts.
std::string release_table(const RunData& data) {
  std::string rows;
  auto out = std::back_inserter(rows);
  for (std::size_t k = 0; k < data.run.stages.size(); ++k) {
    for (const record::ReleasePoint& p : data.run.stages[k].release) {
      const auto e = static_cast<std::size_t>(p.excavation);
      const std::string name = e < data.model.excavation_names.size() ? data.model.excavation_names[e] : "";
      fmt::format_to(out, "{},{},{},{}", k, p.step, csv_field(name), p.released);
      for (const double moved : {p.crown, p.springline, p.mean}) {
        if (std::isnan(moved)) {
          rows += ',';
        } else {
          fmt::format_to(out, ",{}", moved);
        }
      }
      rows += '\n';
    }
  }
  return rows.empty() ? rows : "stage,step,excavation,released,crown,springline,mean\n" + rows;
}

ordered_json closed_ring(const Ring& ring) {
  ordered_json out = ordered_json::array();
  for (std::size_t k = 0; k <= ring.size(); ++k)
    out.push_back({ring[k % ring.size()].x, ring[k % ring.size()].y});
  return out;
}

std::string stage_geojson(const RunData& data, const record::Frame& frame) {
  ordered_json features = ordered_json::array();
  for (std::size_t b = 0; b < data.model.blocks.size(); ++b) {
    if (frame.status[b] == record::BlockStatus::excavated) continue;
    const Polygon polygon = block_shape(data.model, frame, b);
    ordered_json rings = ordered_json::array();
    for (std::size_t r = 0; r < polygon.ring_count(); ++r) rings.push_back(closed_ring(polygon.ring(r)));
    const Vec2 u = block_displacement(data.model, frame, b);
    features.push_back({{"type", "Feature"},
                        {"properties",
                         {{"block", b},
                          {"name", data.model.blocks[b].name},
                          {"status", status_name(frame.status[b])},
                          {"displacement_m", norm(u)},
                          {"ux_m", u.x},
                          {"uy_m", u.y},
                          {"sxx_pa", frame.stress[b][0]},
                          {"syy_pa", frame.stress[b][1]},
                          {"sxy_pa", frame.stress[b][2]}}},
                        {"geometry", {{"type", "Polygon"}, {"coordinates", rings}}}});
  }
  const ordered_json collection{{"type", "FeatureCollection"}, {"features", features}};
  return collection.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::optional<ExportFormat> export_format(std::string_view name) {
  for (const auto& [format, known] : formats) {
    if (known == name) return format;
  }
  return {};
}

std::vector<std::filesystem::path> export_csv(const RunData& data, FileSet& out) {
  std::vector<std::filesystem::path> files{out.write("blocks.csv", block_table(data)),
                                           out.write("contacts.csv", contact_table(data)),
                                           out.write("steps.csv", step_table(data))};
  if (const std::string joints = joint_table(data.model); !joints.empty())
    files.push_back(out.write("joints.csv", joints));
  if (has_histories(data.model))
    files.push_back(out.write("histories.csv", histories_csv(data.model, data.histories)));
  if (const std::string breaks = break_table(data); !breaks.empty())
    files.push_back(out.write("breaks.csv", breaks));
  if (const std::string elements = element_table(data.run.elements, data.model.origin); !elements.empty())
    files.push_back(out.write("elements.csv", elements));
  if (const std::string states = element_state_table(data); !states.empty())
    files.push_back(out.write("element_frames.csv", states));
  if (const std::string releases = release_table(data); !releases.empty())
    files.push_back(out.write("release.csv", releases));
  return files;
}

std::vector<std::filesystem::path> export_geojson(const RunData& data, FileSet& out) {
  std::vector<std::filesystem::path> files;
  for (const StageEnd& end : stage_ends(data, ".geojson"))
    files.push_back(out.write(end.file, stage_geojson(data, *end.frame)));
  return files;
}

std::vector<std::filesystem::path> export_run(const RunData& data, const std::filesystem::path& folder,
                                              ExportFormat format, bool replace) {
  ExportFolder out(folder, format_name(format), replace);
  std::vector<std::filesystem::path> files;
  switch (format) {
    case ExportFormat::vtk:
      files = export_vtk(data, out.files());
      break;
    case ExportFormat::csv:
      files = export_csv(data, out.files());
      break;
    case ExportFormat::geojson:
      files = export_geojson(data, out.files());
      break;
    case ExportFormat::dxf:
      files = export_dxf(data, out.files());
      break;
  }
  out.commit(files);
  return files;
}

}  // namespace keyblock::results
