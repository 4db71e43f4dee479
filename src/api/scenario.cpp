#include "keyblock/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "api/edge_names.h"
#include "api/known_keys.h"
#include "api/scenario_source.h"
#include "api/unknown_keys.h"
#include "core/atomic_file.h"
#include "core/checked_json.h"
#include "core/folder.h"
#include "core/read_file.h"
#include "job/check.h"
#include "scenario/build.h"
#include "scenario/key_blocks.h"
#include "scenario/override.h"
#include "scenario/own_joints.h"
#include "scenario/parse.h"
#include "scenario/toml_text.h"

namespace keyblock {
namespace {

using nlohmann::ordered_json;
using Node = scenario::Value;

ordered_json to_json(const Node& value) {
  switch (value.type) {
    case Node::Type::string:
    case Node::Type::date:
      return value.text;
    case Node::Type::integer:
      return value.integer;
    case Node::Type::number:
      return value.number;
    case Node::Type::boolean:
      return value.boolean;
    case Node::Type::array: {
      ordered_json list = ordered_json::array();
      for (const Node& item : value.items) list.push_back(to_json(item));
      return list;
    }
    case Node::Type::table: {
      ordered_json table = ordered_json::object();
      for (const Node& item : value.items) table[item.key] = to_json(item);
      return table;
    }
  }
  return nullptr;
}

api::EdgeNames names_of(const scenario::Scenario& scenario) {
  api::EdgeNames names;
  names.joint_sets = scenario::names_of(scenario::own_joint_sets(scenario));
  names.trace_maps = scenario::names_of(scenario::own_trace_maps(scenario));
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

/// What was set, put into what the text says.
struct Scenario::Document {
  using Path = std::vector<scenario::PathSegment>;
  struct Change {
    Path path;
    std::string key;
    std::optional<Node> value;  ///< none: what the document says there, as nothing can move it
  };

  Node value;
  std::vector<Change> changes;

  [[nodiscard]] const Node& value_of(const Change& change) const;
};

namespace api {

struct ScenarioAccess {
  static const Node& document(const Scenario& scenario) { return scenario.document_->value; }
};

scenario::Scenario parsed(const Scenario& scenario) {
  std::string text = scenario.text();
  if (!scenario.is_made()) text = scenario::with_overrides(std::move(text), scenario.changes());
  return scenario::parse_document(ScenarioAccess::document(scenario), scenario.file(), std::move(text));
}

}  // namespace api

Scenario::Scenario() : document_(std::make_shared<Document>()) {}

Scenario Scenario::empty(std::filesystem::path file) {
  Scenario scenario;
  scenario.file_ = std::move(file);
  return scenario;
}

Scenario Scenario::load(const std::filesystem::path& file) {
  return parse(read_file(file, scenario::largest_scenario), file);
}

Scenario Scenario::parse(std::string text, std::filesystem::path file) {
  Scenario scenario;
  scenario.document_->value = scenario::parse_toml(text, file.string());
  scenario.text_ = std::make_shared<const std::string>(std::move(text));
  scenario.file_ = std::move(file);
  return scenario;
}

void Scenario::set(const std::string& key, const std::string& toml) {
  put(scenario::parse_override(key + "=" + toml), key);
}

void Scenario::set(const std::string& key, const Value& value) {
  put(scenario::make_override(key, api::document_value(value)), key);
}

void Scenario::append(const std::string& key, const std::string& toml) {
  add(key, {scenario::parse_override(key + "=" + toml).value});
}

void Scenario::append(const std::string& key, const Value& value) {
  add(key, {api::document_value(value)});
}

void Scenario::extend(const std::string& key, const Value::List& values) {
  std::vector<Node> elements;
  elements.reserve(values.size());
  for (const Value& value : values) elements.push_back(api::document_value(value));
  add(key, std::move(elements));
}

/// Copies of this scenario keep what they say.
Scenario::Document& Scenario::own_document() {
  if (document_.use_count() > 1) document_ = std::make_shared<Document>(*document_);
  return *document_;
}

void Scenario::put(const scenario::Override& override_, const std::string& key) {
  if (const auto mistake = scenario::apply_override(override_, own_document().value))
    throw InputError(*mistake);
  note_change(override_.path, key);
}

void Scenario::add(const std::string& key, std::vector<Node> elements) {
  const scenario::Override list = scenario::make_override(key, api::document_value(Value::List()));
  const Node* there = scenario::find_value(list.path, document_->value);
  if (there != nullptr && !there->is(Node::Type::array)) {
    Diagnostic diagnostic;
    diagnostic.key = key;
    diagnostic.found = scenario::describe(*there);
    diagnostic.expected = "a list";
    throw InputError(std::move(diagnostic));
  }
  Document& document = own_document();
  if (there == nullptr) {
    if (const auto mistake = scenario::apply_override(list, document.value)) throw InputError(*mistake);
  }
  std::vector<Node>& items = scenario::find_value(list.path, document.value)->items;
  items.insert(items.end(), std::make_move_iterator(elements.begin()),
               std::make_move_iterator(elements.end()));
  note_change(list.path, key);
}

/// What lies in what is replaced now counts no more.
void Scenario::note_change(const Document::Path& path, const std::string& key) {
  std::vector<Document::Change>& changes = document_->changes;
  std::erase_if(changes,
                [&](const Document::Change& change) { return scenario::begins_with(change.path, path); });
  // Keys at the top have no other place to go to, and their lists may be long.
  std::optional<Node> value;
  if (path.size() > 1) value = *scenario::find_value(path, document_->value);
  changes.push_back({path, key, std::move(value)});
}

void Scenario::remove(const std::string& key) {
  const scenario::Override at = scenario::make_override(key, {});
  if (!scenario::remove_value(at.path, own_document().value)) {
    Diagnostic diagnostic;
    diagnostic.key = key;
    diagnostic.found = "nothing";
    diagnostic.expected = "a key, or an element of a list, that the scenario has";
    throw InputError(std::move(diagnostic));
  }
  text_ = nullptr;
  document_->changes.clear();
}

const Node& Scenario::Document::value_of(const Change& change) const {
  return change.value ? *change.value : *scenario::find_value(change.path, value);
}

std::vector<std::string> Scenario::changes() const {
  std::vector<std::string> texts;
  for (const Document::Change& change : document_->changes)
    texts.push_back(change.key + "=" + scenario::to_toml(document_->value_of(change)));
  return texts;
}

std::vector<std::pair<std::string, Value>> Scenario::values_set() const {
  std::vector<std::pair<std::string, Value>> values;
  for (const Document::Change& change : document_->changes)
    values.emplace_back(change.key, api::public_value(document_->value_of(change)));
  return values;
}

namespace {

/// Paths that count from the folder `from`: from `to`.
void move_paths(Node& value, const std::filesystem::path& from, const std::filesystem::path& to) {
  if (value.key == "file" && value.is(Node::Type::string) && !value.text.empty() &&
      std::filesystem::path(value.text).is_relative()) {
    const std::filesystem::path moved = (from / value.text).lexically_normal().lexically_relative(to);
    if (!moved.empty()) value.text = moved.string();
  }
  for (Node& item : value.items) move_paths(item, from, to);
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal().parent_path();
}

}  // namespace

void Scenario::save(const std::filesystem::path& file) const {
  Node moved = document_->value;
  for (Node& section : moved.items) {
    if (section.key == "motion" || section.key == "trace_map")
      move_paths(section, folder_of(file_), folder_of(file));
  }
  check_can_write(file);
  write_file_atomically(file, scenario::toml_text(moved));
}

std::string Scenario::text() const {
  return is_made() ? scenario::toml_text(document_->value) : *text_;
}

namespace {

const Node* find(const std::string& key, const Node& document) {
  return key.empty() ? &document : scenario::find_value(scenario::make_override(key, {}).path, document);
}

bool is_table_node(const Node& value) {
  return value.is(Node::Type::table);
}

}  // namespace

std::string Scenario::json(const std::string& key) const {
  const Node* found = find(key, document_->value);
  return found == nullptr ? std::string() : to_json(*found).dump();
}

std::optional<Value> Scenario::value(const std::string& key) const {
  const Node* found = find(key, document_->value);
  return found == nullptr ? std::nullopt : std::optional(api::public_value(*found));
}

std::optional<std::vector<std::string>> Scenario::keys(const std::string& key) const {
  const Node* found = find(key, document_->value);
  if (found == nullptr || !(is_table_node(*found) || found->is(Node::Type::array))) return std::nullopt;
  std::vector<std::string> keys;
  for (const Node& item : found->items) {
    if (is_table_node(*found))
      keys.push_back(item.key);
    else
      keys.push_back(item.name() == nullptr ? "" : *item.name());
  }
  return keys;
}

bool Scenario::has(const std::string& key) const {
  return find(key, document_->value) != nullptr;
}

bool Scenario::is_table(const std::string& key) const {
  const Node* found = find(key, document_->value);
  return found != nullptr && is_table_node(*found);
}

bool Scenario::is_list_of_tables(const std::string& key) const {
  const Node* found = find(key, document_->value);
  if (found != nullptr && found->is(Node::Type::array) && !found->items.empty())
    return std::all_of(found->items.begin(), found->items.end(), is_table_node);
  return (found == nullptr || found->is(Node::Type::array)) && api::is_list_section(key);
}

std::vector<KeyMeaning> Scenario::known_keys(const std::string& table) {
  return api::known_keys(table);
}

void Scenario::check_keys(const std::string& key, const Value& value) {
  api::check_keys(key, value);
}

std::string Scenario::toml() const {
  return scenario::toml_text(document_->value);
}

namespace {

[[noreturn]] void refuse(const char* argument, std::string found, const char* expected) {
  Diagnostic diagnostic;
  diagnostic.key = argument;
  diagnostic.found = std::move(found);
  diagnostic.expected = expected;
  throw InputError(std::move(diagnostic));
}

void check_realization(int realization) {
  if (realization < 0) refuse("realization", std::to_string(realization), "a whole number, at least 0");
}

}  // namespace

std::vector<std::string> Scenario::check(int realization) const {
  check_realization(realization);
  return job::check(api::parsed(*this), realization).warnings;
}

std::vector<Block> Scenario::cut(int realization) const {
  check_realization(realization);
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

Census Scenario::census(int realization, double wanted_factor) const {
  check_realization(realization);
  if (!(wanted_factor >= 1.0) || !std::isfinite(wanted_factor))
    refuse("wanted_factor", fmt::format("{}", wanted_factor), "a factor of safety, at least 1");
  const scenario::Scenario parsed = api::parsed(*this);
  const scenario::BlockModel model = scenario::build_blocks(parsed, realization);
  const census::Census found = scenario::take_census(parsed, model, wanted_factor);
  Census census{{}, found.layers, found.wall, wanted_factor, scenario::census_assumptions};
  for (const census::KeyBlock& key : found.blocks) {
    const Vec2 place = key.centroid + model.system.origin, way = key.removal.direction;
    census.blocks.push_back({key.block,
                             scenario::block_name(parsed, model, key.block),
                             key.layer,
                             {place.x, place.y},
                             key.area,
                             key.depth,
                             key.weight,
                             census::mode_name(key.removal.mode),
                             key.removal.factor(),
                             key.force,
                             {way.x, way.y},
                             scenario::sliding_joints(parsed, key)});
  }
  return census;
}

}  // namespace keyblock
