#include "keyblock/scenario.h"

#include <utility>

#include "api/scenario_source.h"
#include "core/checked_json.h"
#include "core/read_file.h"
#include "job/check.h"
#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario/override.h"
#include "scenario/parse.h"
#include "scenario/toml_text.h"

namespace keyblock {
namespace {

using nlohmann::ordered_json;
using scenario::Value;

/// Applies a change; throws where it does not fit.
void put_in(const std::string& change, Value& document) {
  if (const auto mistake = scenario::apply_override(scenario::parse_override(change), document))
    throw InputError(*mistake);
}

ordered_json to_json(const Value& value) {
  switch (value.type) {
    case Value::Type::string:
    case Value::Type::date:
      return value.text;
    case Value::Type::integer:
      return value.integer;
    case Value::Type::number:
      return value.number;
    case Value::Type::boolean:
      return value.boolean;
    case Value::Type::array: {
      ordered_json list = ordered_json::array();
      for (const Value& item : value.items) list.push_back(to_json(item));
      return list;
    }
    case Value::Type::table: {
      ordered_json table = ordered_json::object();
      for (const Value& item : value.items) table[item.key] = to_json(item);
      return table;
    }
  }
  return nullptr;
}

std::string label_name(cutting::EdgeLabel label, const scenario::Scenario& scenario) {
  const auto index = static_cast<std::size_t>(label.index);
  switch (label.kind) {
    case cutting::EdgeKind::free:
      return {};
    case cutting::EdgeKind::joint_set:
      return scenario.joint_sets.at(index).set.name;
    case cutting::EdgeKind::trace_map:
      return scenario.trace_maps.at(index).name;
    case cutting::EdgeKind::excavation:
      return scenario.excavations.at(index).name;
    case cutting::EdgeKind::domain:
      return "domain";
  }
  return {};
}

Block block_of(const cutting::CutBlock& cut, Vec2 origin, const scenario::Scenario& scenario) {
  Block block;
  const auto add_ring = [&](const Ring& ring) {
    auto& points = block.rings.emplace_back();
    for (const Vec2 p : ring) points.push_back({p.x + origin.x, p.y + origin.y});
  };
  add_ring(cut.polygon.outer);
  for (const Ring& hole : cut.polygon.holes) add_ring(hole);
  for (const auto& ring : cut.labels) {
    auto& names = block.edges.emplace_back();
    for (const cutting::EdgeLabel label : ring) names.push_back(label_name(label, scenario));
  }
  for (const int e : cut.excavations)
    block.excavations.push_back(scenario.excavations.at(static_cast<std::size_t>(e)).name);
  block.area = area(cut.polygon);
  return block;
}

}  // namespace

namespace api {

Value document_of(const Scenario& scenario) {
  Value document = scenario::parse_toml(scenario.text(), scenario.file().string());
  // Where there was no text, it is made of what was set.
  if (!scenario.is_made()) {
    for (const std::string& change : scenario.changes()) put_in(change, document);
  }
  return document;
}

scenario::Scenario parsed(const Scenario& scenario) {
  const std::vector<std::string> none;
  return scenario::parse_scenario_text(scenario.text(), scenario.file(),
                                       scenario.is_made() ? none : scenario.changes());
}

}  // namespace api

Scenario::Scenario() = default;

Scenario Scenario::load(const std::filesystem::path& file) {
  return parse(read_file(file, scenario::largest_scenario), file);
}

Scenario Scenario::parse(std::string text, std::filesystem::path file) {
  scenario::parse_toml(text, file.string());
  Scenario scenario;
  scenario.text_ = std::move(text);
  scenario.file_ = std::move(file);
  scenario.is_made_ = false;
  return scenario;
}

void Scenario::set(const std::string& key, const std::string& toml) {
  std::string change = key + "=" + toml;
  Value document = api::document_of(*this);
  put_in(change, document);
  if (is_made_) text_ = scenario::toml_text(document);
  changes_.push_back(std::move(change));
}

std::string Scenario::json(const std::string& key) const {
  const Value document = api::document_of(*this);
  if (key.empty()) return to_json(document).dump();
  const scenario::Override at = scenario::make_override(key, {});
  const Value* value = scenario::find_value(at.path, document);
  return value == nullptr ? std::string() : to_json(*value).dump();
}

std::string Scenario::toml() const {
  return scenario::toml_text(api::document_of(*this));
}

std::vector<std::string> Scenario::check(int realization) const {
  const scenario::Scenario parsed = api::parsed(*this);
  // Mistakes of all files together, before any block is cut.
  scenario::check_inputs(parsed);
  std::vector<std::string> warnings =
      job::check(parsed, scenario::build_blocks(parsed, realization), realization);
  for (std::string& warning : scenario::study_warnings(parsed)) warnings.push_back(std::move(warning));
  return warnings;
}

std::vector<Block> Scenario::cut(int realization) const {
  const scenario::Scenario parsed = api::parsed(*this);
  const scenario::BlockModel model = scenario::build_blocks(parsed, realization);
  std::vector<Block> blocks;
  for (const cutting::CutBlock& cut : model.system.blocks)
    blocks.push_back(block_of(cut, model.system.origin, parsed));
  // Those of the scenario come last.
  const std::size_t first = blocks.size() - parsed.blocks.size();
  for (std::size_t k = 0; k < parsed.blocks.size(); ++k) blocks[first + k].name = parsed.blocks[k].name;
  return blocks;
}

}  // namespace keyblock
