#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "core/checked_json.h"
#include "core/error.h"
#include "record/record_fields.h"
#include "results/joint_table.h"
#include "results/record_json.h"
#include "results/result_tables.h"

namespace keyblock::results {
namespace {

using hdf5::read_array;
using hdf5::read_column;
using hdf5::write_array;

template <class T>
void write_column(hid_t group, const std::string& name, const std::vector<T>& values) {
  write_array<T>(group, name, {values.size()}, values);
}

void write_points(hid_t group, const std::string& name, const std::vector<Vec2>& points) {
  std::vector<double> xy;
  for (const Vec2 p : points) xy.insert(xy.end(), {p.x, p.y});
  write_array<double>(group, name, {points.size(), 2}, xy);
}

std::vector<Vec2> read_points(hid_t group, const std::string& name) {
  const auto xy = read_array<double>(group, name);
  std::vector<Vec2> points;
  for (std::size_t k = 0; 2 * k + 1 < xy.values.size(); ++k)
    points.push_back({xy.values[2 * k], xy.values[2 * k + 1]});
  return points;
}

// A column that files of version 0.1 may not have: there, every row is `otherwise`.
hdf5::Array<double> read_newer_column(hid_t group, const char* name, std::size_t count, double otherwise) {
  if (H5Lexists(group, name, H5P_DEFAULT) > 0) return read_column<double>(group, name);
  return {{count}, std::vector<double>(count, otherwise)};
}

// Lists of different lengths, one after the other; list k is values[start[k] … start[k + 1]).
struct Lists {
  std::vector<std::int32_t> start{0}, values;
  void add(const std::vector<int>& list) {
    values.insert(values.end(), list.begin(), list.end());
    start.push_back(static_cast<std::int32_t>(values.size()));
  }
  [[nodiscard]] std::vector<int> list(std::size_t k) const {
    return {values.begin() + start.at(k), values.begin() + start.at(k + 1)};
  }
};

Lists read_lists(hid_t group, const std::string& start, const std::string& values, std::size_t count) {
  Lists lists{read_column<std::int32_t>(group, start).values,
              read_column<std::int32_t>(group, values).values};
  bool fits = lists.start.size() == count + 1 && lists.start.front() == 0 &&
              static_cast<std::size_t>(lists.start.back()) == lists.values.size();
  for (std::size_t k = 0; fits && k < count; ++k) fits = lists.start[k] <= lists.start[k + 1];
  if (!fits) throw RunError(fmt::format("model/{} does not fit model/{}", start, values));
  return lists;
}

// Whether everything that is numbered is there.
void check_places(const record::ModelRecord& model) {
  constexpr int least_vertices = 3;  // of a ring
  if (model.edge_label.size() != model.vertices.size())
    throw RunError("model/edge_kind and model/vertices differ in length");
  for (const Vec2 p : model.vertices)
    if (!std::isfinite(p.x) || !std::isfinite(p.y))
      throw RunError("model/vertices holds what is no finite number");
  for (const auto& block : model.blocks) {
    const std::vector<int>& start = block.ring_start;
    bool rings = start.size() >= 2 && start.front() >= 0 &&
                 static_cast<std::size_t>(start.back()) <= model.vertices.size();
    for (std::size_t r = 0; rings && r + 1 < start.size(); ++r)
      rings = start[r + 1] - start[r] >= least_vertices;
    if (!rings) throw RunError("model/ring_start does not give rings of vertices");
    for (const int excavation : block.excavations) {
      if (excavation < 0 || static_cast<std::size_t>(excavation) >= model.excavation_names.size())
        throw RunError("model/excavation is out of range");
    }
  }
}

}  // namespace

namespace {

// All texts, for the readers of keyblock: with a checksum.
void write_texts(hid_t file, const record::ModelRecord& model) {
  nlohmann::ordered_json texts{{"scenario", model.scenario}, {"record", model_json(model)}};
  for (const auto& block : model.blocks) texts["block_names"].push_back(block.name);
  texts["history_names"] = model.history_names;
  for (const auto& element : model.elements) {
    texts["element_names"].push_back(element.name);
    texts["element_kinds"].push_back(element.kind);
  }
  for (const auto& history : model.element_histories) texts["element_history_names"].push_back(history.name);
  texts["energy_names"] = record::energy_names();
  texts["meanings"] = dataset_names(model);
  TextColumn column(file, "texts");
  column.append(texts.dump());
  column.flush();
}

// Dimensions that several groups have.
void write_scales(hid_t file, const record::ModelRecord& model) {
  const auto numbered = [&](const char* name, std::size_t count) {
    std::vector<std::int32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    write_column(file, name, numbers);
    hdf5::make_scale(hdf5::open_dataset(file, name), name);
  };
  numbered("block", model.blocks.size());
  numbered("vertex", model.vertices.size());
  numbered("point", model.history_names.size());
  if (!model.joints.empty()) numbered("joint", model.joints.size());
  if (!model.elements.empty()) numbered("element", model.elements.size());
  if (!model.element_histories.empty()) numbered("element_history", model.element_histories.size());
  const auto named = [&](const char* name, const std::vector<std::string>& names) {
    hdf5::write_strings(file, name, names);
    hdf5::make_scale(hdf5::open_dataset(file, name), name);
  };
  named("component", {"x", "y"});
  named("stress_component", {"xx", "yy", "xy"});
  named("quantity", record::history_quantities());
  named("energy_term", record::energy_names());
  if (!model.elements.empty()) named("end", {"from", "to"});
  if (!model.element_histories.empty()) {
    std::vector<std::string> quantities;
    for (const auto& field : record::element_history_fields) quantities.emplace_back(field.name);
    named("element_quantity", quantities);
  }
}

struct Texts {
  std::string scenario, record;
  std::vector<std::string> block_names;
};

Texts read_texts(hid_t file, hid_t group) {
  Texts texts;
  if (H5Lexists(file, "texts", H5P_DEFAULT) > 0) {
    try {
      const auto json = nlohmann::json::parse(TextColumn::read(file, "texts"));
      texts.scenario = json.at("scenario").get<std::string>();
      texts.record = json.at("record").get<std::string>();
      if (json.contains("block_names"))
        texts.block_names = json.at("block_names").get<std::vector<std::string>>();
    } catch (const nlohmann::json::exception& error) {
      throw RunError(fmt::format("texts is no JSON of keyblock: {}", error.what()));
    }
    return texts;
  }
  // Of earlier versions.
  const auto scenario = hdf5::read_strings(file, "scenario"), record = hdf5::read_strings(group, "record");
  if (scenario.size() != 1 || record.size() != 1) throw RunError("scenario or model/record is not one text");
  return {scenario[0], record[0], hdf5::read_strings(group, "block_name")};
}

}  // namespace

void write_model(hid_t file, const record::ModelRecord& model) {
  hdf5::write_attribute(file, "format", std::string(result_format));
  hdf5::write_attribute<std::int32_t>(file, "format_version", result_format_version);
  hdf5::write_attribute(file, "title", model.title);
  hdf5::write_attribute(file, "version", model.version);
  hdf5::write_attribute<std::uint64_t>(file, "seed", model.seed);
  hdf5::write_attribute<std::int32_t>(file, "realization", model.realization);
  write_texts(file, model);
  write_scales(file, model);
  hdf5::write_strings(file, "scenario", {model.scenario});
  const hdf5::Handle group = hdf5::create_group(file, "model");
  hdf5::write_strings(group, "record", {model_json(model)});

  std::vector<std::string> name;
  std::vector<std::int32_t> order;
  std::vector<std::uint8_t> fixed, edge_kind;
  std::vector<std::int16_t> edge_index;
  std::vector<std::int32_t> edge_trace;
  std::vector<double> area, density, ratio_zz, young, poisson;
  std::vector<Vec2> centroid;
  Lists rings, excavations;
  for (const auto& block : model.blocks) {
    name.push_back(block.name);
    order.push_back(block.order);
    fixed.push_back(block.fixed ? 1 : 0);
    area.push_back(block.area);
    density.push_back(block.density);
    ratio_zz.push_back(block.stress_ratio_zz);
    young.push_back(block.young);
    poisson.push_back(block.poisson);
    centroid.push_back(block.centroid);
    rings.add(block.ring_start);
    excavations.add(block.excavations);
  }
  for (const cutting::EdgeLabel label : model.edge_label) {
    edge_kind.push_back(static_cast<std::uint8_t>(label.kind));
    edge_index.push_back(label.index);
    edge_trace.push_back(label.trace);
  }
  hdf5::write_strings(group, "block_name", name);
  write_column(group, "block_order", order);
  write_column(group, "block_fixed", fixed);
  write_column(group, "block_area", area);
  write_column(group, "block_density", density);
  write_column(group, "block_stress_ratio_zz", ratio_zz);
  write_column(group, "block_young", young);
  write_column(group, "block_poisson", poisson);
  write_points(group, "block_centroid", centroid);
  write_column(group, "block_rings", rings.start);
  write_column(group, "ring_start", rings.values);
  write_column(group, "block_excavations", excavations.start);
  write_column(group, "excavation", excavations.values);
  write_points(group, "vertices", model.vertices);
  write_column(group, "edge_kind", edge_kind);
  write_column(group, "edge_index", edge_index);
  write_column(group, "edge_trace", edge_trace);
  write_joints(file, model);
  write_element_catalogue(file, model);
}

record::ModelRecord read_model(hid_t file) {
  record::ModelRecord model;
  const hdf5::Handle group = hdf5::open_group(file, "model");
  const Texts texts = read_texts(file, group);
  read_model_json(texts.record, model);
  model.scenario = texts.scenario;
  const std::vector<std::string>& name = texts.block_names;
  const auto order = read_column<std::int32_t>(group, "block_order");
  const auto fixed = read_column<std::uint8_t>(group, "block_fixed");
  const auto area = read_column<double>(group, "block_area"),
             density = read_column<double>(group, "block_density");
  const std::size_t count = name.size();
  const auto ratio_zz = read_newer_column(group, "block_stress_ratio_zz", count, 0.0);
  const double unknown = std::nan("");
  const auto young = read_newer_column(group, "block_young", count, unknown),
             poisson = read_newer_column(group, "block_poisson", count, unknown);
  const auto centroid = read_points(group, "block_centroid");
  if (order.rows() != count || fixed.rows() != count || area.rows() != count || density.rows() != count ||
      ratio_zz.rows() != count || young.rows() != count || poisson.rows() != count ||
      centroid.size() != count) {
    throw RunError("the columns of model/block_… differ in length");
  }
  const Lists rings = read_lists(group, "block_rings", "ring_start", count);
  const Lists excavations = read_lists(group, "block_excavations", "excavation", count);
  for (std::size_t b = 0; b < count; ++b) {
    model.blocks.push_back({name[b], order.values[b], fixed.values[b] != 0, area.values[b], density.values[b],
                            excavations.list(b), centroid[b], rings.list(b), ratio_zz.values[b],
                            young.values[b], poisson.values[b]});
  }
  model.vertices = read_points(group, "vertices");
  const auto edge_kind = read_column<std::uint8_t>(group, "edge_kind");
  const auto edge_index = read_column<std::int16_t>(group, "edge_index");
  // Files of earlier versions have none.
  const bool has_traces = H5Lexists(group, "edge_trace", H5P_DEFAULT) > 0;
  const auto edge_trace =
      has_traces
          ? read_column<std::int32_t>(group, "edge_trace")
          : hdf5::Array<std::int32_t>{{edge_kind.rows()}, std::vector<std::int32_t>(edge_kind.rows(), -1)};
  if (edge_kind.rows() != edge_index.rows() || edge_kind.rows() != edge_trace.rows())
    throw RunError("model/edge_kind, model/edge_index and model/edge_trace differ in length");
  for (std::size_t k = 0; k < edge_kind.rows(); ++k) {
    if (edge_kind.values[k] > static_cast<std::uint8_t>(cutting::EdgeKind::domain)) {
      throw RunError("model/edge_kind holds an unknown value");
    }
    model.edge_label.push_back(
        {static_cast<cutting::EdgeKind>(edge_kind.values[k]), edge_index.values[k], edge_trace.values[k]});
  }
  check_places(model);
  read_joints(file, model);
  model.may_break = H5Lexists(file, "breaks", H5P_DEFAULT) > 0;
  read_element_catalogue(file, model);
  return model;
}

}  // namespace keyblock::results
