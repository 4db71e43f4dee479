#include "results/elements_json.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/checked_json.h"
#include "core/error.h"
#include "results/csv.h"
#include "results/json_parts.h"

namespace keyblock::results {

using nlohmann::ordered_json;
using record::element_fields;
using record::element_state_fields;
using record::ElementRecord;

namespace {
ordered_json place(Vec2 p) {
  return {p.x, p.y};
}
Vec2 read_place(const ordered_json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}
}  // namespace

ordered_json element_names_json(const record::ModelRecord& model) {
  ordered_json json = ordered_json::array();
  for (const auto& e : model.elements)
    json.push_back({{"name", e.name}, {"kind", e.kind}, {"limit_n_m", number_or_null(e.limit)}});
  return json;
}

ordered_json element_histories_json(const record::ModelRecord& model) {
  ordered_json json = ordered_json::array();
  for (const auto& h : model.element_histories) json.push_back({{"name", h.name}, {"element", h.element}});
  return json;
}

void add_element_names(const record::ModelRecord& model, ordered_json& json) {
  if (!model.elements.empty()) json["elements"] = element_names_json(model);
  if (!model.element_histories.empty()) json["element_histories"] = element_histories_json(model);
}

void read_element_names(const ordered_json& json, record::ModelRecord& model) {
  if (!json.contains("elements")) return;
  for (const ordered_json& one : json.at("elements")) {
    record::ElementDescription& e = model.elements.emplace_back();
    one.at("name").get_to(e.name);
    one.at("kind").get_to(e.kind);
  }
  if (!json.contains("element_histories")) return;
  for (const ordered_json& one : json.at("element_histories")) {
    const auto& h = model.element_histories.emplace_back(
        record::ElementHistory{one.at("name").get<std::string>(), one.at("element").get<int>()});
    if (h.element < 0 || static_cast<std::size_t>(h.element) >= model.elements.size())
      throw RunError("a history follows an element that is not there");
  }
}

ordered_json elements_json(const std::vector<ElementRecord>& elements, Vec2 origin) {
  ordered_json json = ordered_json::array();
  for (const ElementRecord& e : elements) {
    ordered_json one{{"name", e.name},
                     {"kind", e.kind},
                     {"present", e.present},
                     {"from", place(e.from + origin)},
                     {"to", place(e.to + origin)}};
    for (const auto& field : element_fields) one[field.name] = number_or_null(e.*field.number);
    one["peak_stage"] = e.peak_stage.empty() ? ordered_json() : ordered_json(e.peak_stage);
    one["utilization"] = e.has_limit() ? ordered_json(e.utilization()) : ordered_json();
    one["has_yielded"] = e.has_yielded();
    one["has_ruptured"] = e.ruptured;
    json.push_back(std::move(one));
  }
  return json;
}

ordered_json water_json(const record::WaterRecord& water) {
  ordered_json forces = ordered_json::array();
  for (const auto& [name, force] : water.forces)
    forces.push_back({{"name", name}, {"force_n_m", place(force)}});
  return {{"name", water.name},
          {"largest_pressure_pa", water.largest_pressure},
          {"wet_m", water.wet},
          {"drained_m", water.drained},
          {"forces", std::move(forces)}};
}

record::WaterRecord read_water(const ordered_json& json) {
  record::WaterRecord water;
  json.at("name").get_to(water.name);
  json.at("largest_pressure_pa").get_to(water.largest_pressure);
  json.at("wet_m").get_to(water.wet);
  json.at("drained_m").get_to(water.drained);
  for (const ordered_json& one : json.at("forces"))
    water.forces.emplace_back(one.at("name").get<std::string>(), read_place(one.at("force_n_m")));
  return water;
}

std::vector<ElementRecord> read_elements(const ordered_json& json) {
  std::vector<ElementRecord> elements;
  for (const ordered_json& one : json) {
    ElementRecord e;
    e.name = one.at("name").get<std::string>();
    e.kind = one.at("kind").get<std::string>();
    one.at("present").get_to(e.present);
    one.at("has_ruptured").get_to(e.ruptured);
    e.from = read_place(one.at("from"));
    e.to = read_place(one.at("to"));
    for (const auto& field : element_fields) {
      if (&field >= element_fields + record::first_new_element_field && !one.contains(field.name)) continue;
      const ordered_json& value = one.at(field.name);
      e.*field.number = value.is_null() ? HUGE_VAL : value.get<double>();
    }
    if (!one.at("peak_stage").is_null()) e.peak_stage = one.at("peak_stage").get<std::string>();
    elements.push_back(std::move(e));
  }
  return elements;
}

std::string element_table(const std::vector<ElementRecord>& elements, Vec2 origin) {
  if (elements.empty()) return {};
  std::string text = "name,kind,present,from_x,from_y,to_x,to_y";
  for (const auto& field : element_fields) text += fmt::format(",{}", field.name);
  text += ",peak_stage\n";
  auto out = std::back_inserter(text);
  for (const ElementRecord& e : elements) {
    const Vec2 from = e.from + origin, to = e.to + origin;
    fmt::format_to(out, "{},{},{},{},{},{},{}", csv_field(e.name), e.kind, e.present ? 1 : 0, from.x, from.y,
                   to.x, to.y);
    for (const auto& field : element_fields) {
      const double value = e.*field.number;
      text += std::isfinite(value) ? fmt::format(",{}", value) : ",";
    }
    fmt::format_to(out, ",{}\n", csv_field(e.peak_stage));
  }
  return text;
}

std::string element_state_table(const RunData& run) {
  const record::ModelRecord& model = run.model;
  if (model.elements.empty()) return {};
  std::string text = "frame,time,stage,step,element,name,kind,present,from_x,from_y,to_x,to_y";
  for (const auto& field : element_state_fields) text += fmt::format(",{}", field.name);
  text += '\n';
  auto out = std::back_inserter(text);
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    const record::Frame& frame = run.frames[f];
    for (std::size_t k = 0; k < frame.elements.size(); ++k) {
      const record::ElementDescription& of = model.elements[k];
      const record::ElementState& e = frame.elements[k];
      const Vec2 from = e.from + model.origin, to = e.to + model.origin;
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{},{}", f, frame.time, frame.stage, frame.step, k,
                     csv_field(of.name), of.kind, e.present ? 1 : 0, from.x, from.y, to.x, to.y);
      for (const auto& field : element_state_fields) {
        const double value = e.*field.number;
        text += std::isnan(value) ? "," : fmt::format(",{}", value);
      }
      text += '\n';
    }
  }
  return text;
}

}  // namespace keyblock::results
