#include "results/stage_json.h"

#include <string_view>
#include <utility>

#include "core/checked_json.h"
#include "record/verdict.h"
#include "results/field_json.h"
#include "results/json_parts.h"

namespace keyblock::results {
namespace {

using nlohmann::ordered_json;
using record::StageField;
using record::StageKind;

/// "group.name" in two; without a group that is empty.
std::pair<std::string, std::string> split(std::string_view name) {
  const std::size_t point = name.find('.');
  if (point == std::string_view::npos) return {"", std::string(name)};
  return {std::string(name.substr(0, point)), std::string(name.substr(point + 1))};
}

}  // namespace

ordered_json stage_fields_json(const record::StageRecord& stage, record::RecordFile file) {
  ordered_json json;
  record::visit_stage(stage, [&](const StageField& field, const auto& value) {
    if (field.file > file) return;
    const auto [group, name] = split(field.name);
    (group.empty() ? json : json[group])[name] = json_of(value);
  });
  return json;
}

void read_stage_fields(const ordered_json& json, record::StageRecord& stage) {
  record::visit_stage(stage, [&](const StageField& field, auto& value) { read_field(json, field, value); });
}

void add_verdict(const record::StageRecord& stage, ordered_json& equilibrium) {
  const bool is_static = stage.stage.kind == StageKind::settle;
  equilibrium["verdict"] = is_static ? ordered_json(record::verdict_text(stage)) : ordered_json();
  equilibrium["moving"] = movements_json(stage);
}

}  // namespace keyblock::results
