#include "keyblock/scenario.h"

#include <utility>

#include "api/edge_names.h"
#include "api/scenario_source.h"
#include "core/checked_json.h"
#include "core/read_file.h"
#include "job/check.h"
#include "scenario/build.h"
#include "scenario/override.h"
#include "scenario/parse.h"
#include "scenario/toml_text.h"

namespace keyblock {
namespace {

using nlohmann::ordered_json;
using scenario::Value;

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

api::EdgeNames names_of(const scenario::Scenario& scenario) {
  api::EdgeNames names;
  for (const auto& spec : scenario.joint_sets) names.joint_sets.push_back(spec.set.name);
  for (const auto& spec : scenario.trace_maps) names.trace_maps.push_back(spec.name);
  for (const auto& spec : scenario.excavations) names.excavations.push_back(spec.name);
  return names;
}

Block block_of(const cutting::CutBlock& cut, Vec2 origin, const api::EdgeNames& names) {
  Block block;
  const auto add_ring = [&](const Ring& ring) {
    auto& points = block.rings.emplace_back();
    for (const Vec2 p : ring) points.push_back({p.x + origin.x, p.y + origin.y});
  };
  add_ring(cut.polygon.outer);
  for (const Ring& hole : cut.polygon.holes) add_ring(hole);
  for (const auto& ring : cut.labels) {
    auto& edges = block.edges.emplace_back();
    for (const cutting::EdgeLabel label : ring) edges.push_back(names.of(label));
  }
  for (const int e : cut.excavations)
    block.excavations.push_back(names.excavations.at(static_cast<std::size_t>(e)));
  block.area = area(cut.polygon);
  return block;
}

}  // namespace

using Path = std::vector<scenario::PathSegment>;

/// What was set, put into what the text says.
struct Scenario::Document {
  Value value;
  std::vector<Path> changed;  ///< by each of Scenario::changes
};

namespace api {

scenario::Scenario parsed(const Scenario& scenario) {
  const std::vector<std::string> none;
  return scenario::parse_scenario_text(scenario.text(), scenario.file(),
                                       scenario.is_made() ? none : scenario.changes());
}

}  // namespace api

Scenario::Scenario() : document_(std::make_shared<Document>()) {}

Scenario Scenario::load(const std::filesystem::path& file) {
  return parse(read_file(file, scenario::largest_scenario), file);
}

Scenario Scenario::parse(std::string text, std::filesystem::path file) {
  Scenario scenario;
  scenario.document_ = std::make_shared<Document>(Document{scenario::parse_toml(text, file.string()), {}});
  scenario.text_ = std::move(text);
  scenario.file_ = std::move(file);
  scenario.is_made_ = false;
  return scenario;
}

void Scenario::set(const std::string& key, const std::string& toml) {
  std::string change = key + "=" + toml;
  const scenario::Override override_ = scenario::parse_override(change);
  put(override_, std::move(change));
}

void Scenario::append(const std::string& key, const std::string& toml) {
  scenario::Override list = scenario::make_override(key, {});
  list.value.type = Value::Type::array;
  if (const Value* there = scenario::find_value(list.path, document_->value)) list.value = *there;
  if (!list.value.is(Value::Type::array)) {
    Diagnostic diagnostic;
    diagnostic.key = key;
    diagnostic.found = scenario::describe(list.value);
    diagnostic.expected = "a list";
    throw InputError(std::move(diagnostic));
  }
  list.value.items.push_back(scenario::parse_override(key + "=" + toml).value);
  std::string change = key + "=" + scenario::to_toml(list.value);
  put(list, std::move(change));
}

void Scenario::put(const scenario::Override& override_, std::string change) {
  // Copies of this scenario keep what they say.
  auto document = std::make_shared<Document>(*document_);
  if (const auto mistake = scenario::apply_override(override_, document->value)) throw InputError(*mistake);
  // What lies in what is replaced now counts no more.
  std::vector<std::string> changes;
  std::vector<Path> paths;
  for (std::size_t k = 0; k < changes_.size(); ++k) {
    if (scenario::begins_with(document->changed[k], override_.path)) continue;
    changes.push_back(std::move(changes_[k]));
    paths.push_back(std::move(document->changed[k]));
  }
  changes.push_back(std::move(change));
  paths.push_back(override_.path);
  document->changed = std::move(paths);
  changes_ = std::move(changes);
  document_ = std::move(document);
}

std::string Scenario::text() const {
  return is_made_ ? scenario::toml_text(document_->value) : text_;
}

std::string Scenario::json(const std::string& key) const {
  if (key.empty()) return to_json(document_->value).dump();
  const scenario::Override at = scenario::make_override(key, {});
  const Value* value = scenario::find_value(at.path, document_->value);
  return value == nullptr ? std::string() : to_json(*value).dump();
}

std::string Scenario::toml() const {
  return scenario::toml_text(document_->value);
}

std::vector<std::string> Scenario::check(int realization) const {
  return job::check(api::parsed(*this), realization).warnings;
}

std::vector<Block> Scenario::cut(int realization) const {
  const scenario::Scenario parsed = api::parsed(*this);
  const scenario::BlockModel model = scenario::build_blocks(parsed, realization);
  const api::EdgeNames names = names_of(parsed);
  std::vector<Block> blocks;
  for (const cutting::CutBlock& cut : model.system.blocks)
    blocks.push_back(block_of(cut, model.system.origin, names));
  // Those of the scenario come last.
  const std::size_t first = blocks.size() - parsed.blocks.size();
  for (std::size_t k = 0; k < parsed.blocks.size(); ++k) blocks[first + k].name = parsed.blocks[k].name;
  return blocks;
}

}  // namespace keyblock
