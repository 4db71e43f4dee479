#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/checked_json.h"
#include "record/contact_fields.h"
#include "record/record_fields.h"
#include "results/block_shape.h"
#include "results/result_tables.h"

namespace keyblock::results {
namespace {

using Names = std::vector<std::string>;

struct Meaning {
  std::string dataset;
  std::string
      unit;  ///< "1": a number without a unit; "": text; of columns that differ, one for each, after commas
  const char* description;
  Names columns{};  ///< of the last dimension
  Names values{};   ///< by number
};

/// The dimensions of datasets, by the scales that they are; of all others nothing is said.
struct Dimensions {
  std::string dataset;
  Names scales;
};

/// Columns of a table that is described by its fields, along the time of its rows.
template <class Fields>
void add_rows(const char* time, const Fields& fields, std::vector<Dimensions>& all) {
  const std::string group(time, std::string_view(time).rfind('/') + 1);
  record::visit_fields(fields, [&]<class Row, class T>(const record::RowField<Row, T>& field) {
    if (group + field.name == time) return;
    all.push_back({group + field.name, {time}});
    if constexpr (std::is_same_v<T, Vec2>) all.back().scales.emplace_back("component");
  });
}

std::vector<Dimensions> dimensions(const record::ModelRecord& model) {
  const char *const frame = "frames/time", *const snapshot = "contacts/time",
                    *const contact = "contacts/contact", *const row = "histories/time",
                    *const step = "steps/time";
  std::vector<Dimensions> all{{"frames/displacement", {frame, "vertex", "component"}},
                              {"frames/velocity", {frame, "block", "component"}},
                              {"frames/stress", {frame, "block", "stress_component"}},
                              {"frames/status", {frame, "block"}},
                              {"frames/order", {frame, "block"}},
                              {"histories/names", {"point"}},
                              {"histories/values", {row, "point", "quantity"}},
                              {"steps/energy", {step, "energy_term"}},
                              {"steps/energy_names", {"energy_term"}},
                              {"model/vertices", {"vertex", "component"}},
                              {"model/edge_kind", {"vertex"}},
                              {"model/edge_index", {"vertex"}},
                              {"model/edge_trace", {"vertex"}},
                              {"model/block_centroid", {"block", "component"}},
                              {"contacts/position", {contact, "component"}},
                              {"contacts/normal", {contact, "component"}}};
  for (const char* name : {"frames/stage", "frames/step"}) all.push_back({name, {frame}});
  for (const char* name : {"contacts/stage", "contacts/step", "contacts/end"})
    all.push_back({name, {snapshot}});
  all.push_back({"histories/step", {row}});
  add_rows(step, record::step_fields, all);
  if (model.may_break) add_rows("breaks/time", record::break_fields, all);
  for (const char* name : {"contacts/block_a", "contacts/block_b", "contacts/state", "contacts/edge_kind",
                           "contacts/edge_index"})
    all.push_back({name, {contact}});
  for (const record::ContactField& field : record::contact_fields)
    all.push_back({"contacts/" + std::string(field.name), {contact}});
  for (const char* name :
       {"model/block_name", "model/block_order", "model/block_fixed", "model/block_area",
        "model/block_density", "model/block_stress_ratio_zz", "model/block_young", "model/block_poisson"})
    all.push_back({name, {"block"}});
  if (!model.joints.empty()) {
    for (const char* name : {"joints/edge_kind", "joints/edge_index", "joints/trace"})
      all.push_back({name, {"joint"}});
    for (const record::JointField& field : record::joint_fields)
      all.push_back({"joints/" + std::string(field.name), {"joint"}});
  }
  if (!model.elements.empty()) {
    for (const char* name : {"elements/name", "elements/kind", "elements/limit", "elements/spacing"})
      all.push_back({name, {"element"}});
    all.push_back({"elements/reference", {"element", "end", "component"}});
    all.push_back({"elements/block", {"element", "end"}});
    all.push_back({"elements/ends", {frame, "element", "end", "component"}});
    all.push_back({"elements/present", {frame, "element"}});
    for (const auto& field : record::element_state_fields)
      all.push_back({"elements/" + std::string(field.name), {frame, "element"}});
  }
  if (!model.element_histories.empty()) {
    all.push_back({"histories/element_names", {"element_history"}});
    all.push_back({"histories/element_values", {row, "element_history", "element_quantity"}});
  }
  return all;
}

template <class Enum>
Names names_up_to(Enum last, std::string (*name)(Enum)) {
  Names names;
  for (int k = 0; k <= static_cast<int>(last); ++k) names.push_back(name(static_cast<Enum>(k)));
  return names;
}

/// Units of columns, one for each, after commas.
template <class Fields>
std::string units_of(const Fields& fields) {
  std::string units;
  for (const auto& field : fields) units += (units.empty() ? "" : ", ") + std::string(field.unit);
  return units;
}

std::vector<Meaning> of_the_model() {
  const Names kinds = names_up_to(cutting::EdgeKind::domain, edge_kind_name);
  return {
      {"scenario", "", "the scenario that was run, TOML"},
      {"texts", "", "all texts of the file as JSON, bytes: what keyblock itself reads, as it has a checksum"},
      {"block", "1", "number of the block"},
      {"vertex", "1", "number of the display vertex"},
      {"point", "1", "number of the chosen point"},
      {"component", "", "of vectors"},
      {"stress_component", "", "of stresses"},
      {"quantity", "", "of histories"},
      {"energy_term", "", "of the energy balance"},
      {"model/record", "", "names, outlines, limits and what cutting did, JSON"},
      {"model/vertices", "m", "reference positions of the display vertices", {"x", "y"}},
      {"model/edge_kind",
       "1",
       "what the edge from each vertex to the next of its ring is a piece of",
       {},
       kinds},
      {"model/edge_index", "1", "which joint set, trace map or excavation of edge_kind"},
      {"model/edge_trace", "1", "which trace of the set or map; -1: none"},
      {"model/block_rings", "1",
       "entries [block_rings[b], block_rings[b + 1]) of ring_start belong to block b"},
      {"model/ring_start", "1",
       "ring r of block b: vertices [ring_start[a + r], ring_start[a + r + 1]), a = block_rings[b]"},
      {"model/block_name", "", "names; empty for cut blocks"},
      {"model/block_order", "1", "order of the displacement polynomial at the start"},
      {"model/block_fixed", "1", "whether the block is fixed", {}, {"free", "fixed"}},
      {"model/block_area", "m2", "reference area"},
      {"model/block_density", "kg/m3", "mass per volume"},
      {"model/block_centroid", "m", "reference position of the centroid", {"x", "y"}},
      {"model/block_stress_ratio_zz", "1",
       "stress zz over xx + yy: 0 in plane stress, Poisson's ratio in plane strain"},
      {"model/block_young", "Pa", "Young's modulus"},
      {"model/block_poisson", "1", "Poisson's ratio"},
      {"model/block_excavations", "1",
       "entries [block_excavations[b], block_excavations[b + 1]) of excavation belong to block b"},
      {"model/excavation", "1", "numbers of excavations"}};
}

std::vector<Meaning> of_frames() {
  return {
      {"frames/time", "s", "simulated time; static steps take none"},
      {"frames/stage", "1", "stage, from 0"},
      {"frames/step", "1", "step of the run"},
      {"frames/displacement", "m", "of every display vertex since the start", {"x", "y"}},
      {"frames/velocity", "m/s", "of the mass centre of every block", {"x", "y"}},
      {"frames/stress", "Pa", "mean Cauchy stress of every block, tension positive", {"xx", "yy", "xy"}},
      {"frames/status", "1", "of every block", {}, names_up_to(record::BlockStatus::excavated, status_name)},
      {"frames/order", "1", "order of the displacement polynomial of every block"}};
}

std::vector<Meaning> of_contacts() {
  std::vector<Meaning> all{
      {"contacts/time", "s", "simulated time of each snapshot"},
      {"contacts/stage", "1", "stage, from 0"},
      {"contacts/step", "1", "step of the run"},
      {"contacts/end", "1", "contacts of snapshot k are the rows [end[k - 1], end[k]), from 0 for the first"},
      {"contacts/contact", "1", "number of the row"},
      {"contacts/block_a", "1", "block with the vertex"},
      {"contacts/block_b", "1", "block with the edge"},
      {"contacts/state",
       "1",
       "state of the contact",
       {},
       names_up_to(record::ContactState::locked, contact_state_name)},
      {"contacts/position", "m", "where", {"x", "y"}},
      {"contacts/normal", "1", "unit vector out of block_b", {"x", "y"}},
      {"contacts/edge_kind",
       "1",
       "what the edge is a piece of",
       {},
       names_up_to(cutting::EdgeKind::domain, edge_kind_name)},
      {"contacts/edge_index", "1", "which joint set, trace map or excavation of edge_kind"}};
  for (const record::ContactField& field : record::contact_fields)
    all.push_back({"contacts/" + std::string(field.name), field.unit, field.meaning});
  return all;
}

std::vector<Meaning> of_rows() {
  return {
      {"histories/names", "", "names of the chosen points"},
      {"histories/time", "s", "simulated time"},
      {"histories/step", "1", "step of the run"},
      {"histories/values", units_of(record::history_fields),
       "of every chosen point: displacement, velocity, stress, and acceleration as its mean over the last "
       "step",
       record::history_quantities()},
      {"steps/energy", units_of(record::energy_fields), "terms of the energy balance per metre of thickness",
       record::energy_names()},
      {"steps/energy_names", "", "names of the columns of energy"},
      {"stages", "", "a JSON object per line, bytes"},
      {"run", "", "a line of JSON at the end of the run, bytes"},
      {"summary", "", "the text of summary.json, bytes"}};
}

Names names_of(cutting::EdgeKind /*any*/) {
  return names_up_to(cutting::EdgeKind::domain, edge_kind_name);
}
Names names_of(record::BreakMode /*any*/) {
  return names_up_to(last_of(record::BreakMode()), record::name_of);
}

/// The columns of a table that is described by its fields.
template <class Fields>
std::vector<Meaning> of_table(const char* group, const Fields& fields) {
  std::vector<Meaning> all;
  record::visit_fields(fields, [&]<class Row, class T>(const record::RowField<Row, T>& field) {
    Meaning& meaning =
        all.emplace_back(Meaning{std::string(group) + "/" + field.name, field.unit, field.meaning});
    if constexpr (std::is_same_v<T, Vec2>) meaning.columns = {"x", "y"};
    if constexpr (std::is_enum_v<T>) meaning.values = names_of(T());
  });
  return all;
}

std::vector<Meaning> of_breaks(const record::ModelRecord& model) {
  return model.may_break ? of_table("breaks", record::break_fields) : std::vector<Meaning>();
}

std::vector<Meaning> of_joints(const record::ModelRecord& model) {
  if (model.joints.empty()) return {};
  std::vector<Meaning> all{
      {"joint", "1", "number of the row of joints"},
      {"joints/edge_kind",
       "1",
       "joint set or trace map",
       {},
       names_up_to(cutting::EdgeKind::domain, edge_kind_name)},
      {"joints/edge_index", "1", "which joint set or trace map"},
      {"joints/trace", "1", "trace whose strength it is, as model/edge_trace; -1: all have it"}};
  for (const record::JointField& field : record::joint_fields)
    all.push_back({"joints/" + std::string(field.name), field.unit, field.meaning});
  return all;
}

std::vector<Meaning> of_elements(const record::ModelRecord& model) {
  if (model.elements.empty()) return {};
  std::vector<Meaning> all{
      {"element", "1", "number of the element"},
      {"end", "", "of elements"},
      {"elements/name", "", "names, as in summary.json"},
      {"elements/kind", "", "what each is: spring, bolt, dowel, liner, support, boundary, pressure, water"},
      {"elements/limit", "N/m", "largest force that it can carry; infinite: none"},
      {"elements/spacing", "m",
       "out of plane, of which the section has one; infinite: it goes on through the section"},
      {"elements/reference",
       "m",
       "ends before the run, or those of the stretch that it supports",
       {"x", "y"}},
      {"elements/block", "1", "blocks of the ends, -1: of several", {"from", "to"}},
      {"elements/ends", "m", "ends in each frame", {"x", "y"}},
      {"elements/present", "1", "whether it is there", {}, {"not there", "there"}}};
  for (const auto& field : record::element_state_fields)
    all.push_back({"elements/" + std::string(field.name), field.unit, field.meaning});
  return all;
}

std::vector<Meaning> of_element_histories(const record::ModelRecord& model) {
  if (model.element_histories.empty()) return {};
  Names names;
  for (const auto& field : record::element_history_fields) names.emplace_back(field.name);
  return {{"element_history", "1", "number of the history that follows an element"},
          {"element_quantity", "", "of these histories"},
          {"histories/element_names", "", "names of the histories that follow elements"},
          {"histories/element_values", units_of(record::element_history_fields),
           "of every such history; NaN where the element is not there", names}};
}

std::vector<Meaning> all_meanings(const record::ModelRecord& model) {
  std::vector<Meaning> all;
  for (auto& meanings :
       {of_the_model(), of_frames(), of_contacts(), of_rows(), of_table("steps", record::step_fields),
        of_breaks(model), of_joints(model), of_elements(model), of_element_histories(model)})
    all.insert(all.end(), meanings.begin(), meanings.end());
  return all;
}

}  // namespace

nlohmann::ordered_json dataset_names(const record::ModelRecord& model) {
  nlohmann::ordered_json names = nlohmann::ordered_json::object();
  for (const Meaning& meaning : all_meanings(model)) {
    if (!meaning.columns.empty()) names[meaning.dataset]["columns"] = meaning.columns;
    if (!meaning.values.empty()) names[meaning.dataset]["values"] = meaning.values;
  }
  return names;
}

void describe_datasets(hid_t file, const record::ModelRecord& model) {
  for (const Meaning& meaning : all_meanings(model)) {
    const hdf5::Handle dataset = hdf5::open_dataset(file, meaning.dataset);
    if (!meaning.unit.empty()) hdf5::write_attribute(dataset, "units", meaning.unit);
    hdf5::write_attribute(dataset, "description", std::string(meaning.description));
    if (!meaning.columns.empty()) hdf5::write_attribute(dataset, "columns", meaning.columns);
    if (!meaning.values.empty()) hdf5::write_attribute(dataset, "values", meaning.values);
  }
  std::vector<const char*> groups{"frames", "contacts", "histories", "steps"};
  if (model.may_break) groups.push_back("breaks");
  for (const char* group : groups)
    hdf5::make_scale(hdf5::open_dataset(file, std::string(group) + "/time"), "time");
  hdf5::make_scale(hdf5::open_dataset(file, "contacts/contact"), "contact");
  for (const Dimensions& of : dimensions(model))
    hdf5::attach_scales(file, hdf5::open_dataset(file, of.dataset), of.scales);
}

}  // namespace keyblock::results
