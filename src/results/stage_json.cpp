#include "results/stage_json.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/checked_json.h"
#include "record/verdict.h"
#include "results/json_parts.h"

namespace keyblock::results {
namespace {

using nlohmann::ordered_json;
using simulation::StageField;
using simulation::StageKind;

constexpr std::pair<StageKind, const char*> kinds[] = {
    {StageKind::settle, "settle"}, {StageKind::shake, "shake"}, {StageKind::rest, "rest"}};

// Values of fields, to JSON.
template <class T>
ordered_json json_of(const T& value) {
  return value;
}
template <class T>
ordered_json json_of(const std::optional<T>& value) {
  return or_null(value);
}
ordered_json json_of(StageKind kind) {
  return stage_kind_name(kind);
}
ordered_json json_of(const std::optional<simulation::StageWait>& wait) {
  return wait_json(wait);
}
ordered_json json_of(const std::optional<simulation::Standing>& standing) {
  return standing_json(standing);
}
ordered_json json_of(const simulation::Movers& movers) {
  return movers_json(movers);
}
ordered_json json_of(const simulation::Damage& damage) {
  return damage_json(damage);
}
ordered_json json_of(const std::vector<simulation::MovingBlock>& moving) {
  return moving_json(moving);
}
ordered_json json_of(const std::vector<simulation::FallenBlock>& fallen) {
  return fallen_json(fallen);
}
ordered_json json_of(const std::vector<simulation::ReleasePoint>& release) {
  return release_json(release, {});
}
ordered_json json_of(const std::vector<Vec2>& points) {
  return points_json(points);
}

// And back.
template <class T>
void read(const ordered_json& json, T& value) {
  json.get_to(value);
}
void read(const ordered_json& json, double& value) {
  value = number(json);
}
template <class T>
void read(const ordered_json& json, std::optional<T>& value) {
  value = json.is_null() ? std::nullopt : std::optional(json.get<T>());
}
void read(const ordered_json& json, StageKind& value) {
  for (const auto& [kind, name] : kinds)
    if (json == name) value = kind;
}
void read(const ordered_json& json, std::optional<simulation::StageWait>& value) {
  value = read_wait(json);
}
void read(const ordered_json& json, std::optional<simulation::Standing>& value) {
  value = read_standing(json);
}
void read(const ordered_json& json, simulation::Movers& value) {
  value = read_movers(json);
}
void read(const ordered_json& json, simulation::Damage& value) {
  value = read_damage(json);
}
void read(const ordered_json& json, std::vector<simulation::MovingBlock>& value) {
  value = read_moving(json);
}
void read(const ordered_json& json, std::vector<simulation::FallenBlock>& value) {
  value = read_fallen(json);
}
void read(const ordered_json& json, std::vector<simulation::ReleasePoint>& value) {
  value = read_release(json);
}
void read(const ordered_json& json, std::vector<double>& value) {
  for (const ordered_json& one : json) value.push_back(number(one));
}
void read(const ordered_json& json, std::vector<Vec2>& value) {
  value = read_points(json);
}

/// "group.name" in two; without a group that is empty.
std::pair<std::string, std::string> split(std::string_view name) {
  const std::size_t point = name.find('.');
  if (point == std::string_view::npos) return {"", std::string(name)};
  return {std::string(name.substr(0, point)), std::string(name.substr(point + 1))};
}

}  // namespace

std::string stage_kind_name(StageKind kind) {
  for (const auto& [known, name] : kinds) {
    if (known == kind) return name;
  }
  return {};
}

ordered_json stage_fields_json(const simulation::StageRecord& stage, simulation::StageFile file) {
  ordered_json json;
  simulation::visit_stage(stage, [&](const StageField& field, const auto& value) {
    if (field.file > file) return;
    const auto [group, name] = split(field.name);
    (group.empty() ? json : json[group])[name] = json_of(value);
  });
  return json;
}

void read_stage_fields(const ordered_json& json, simulation::StageRecord& stage) {
  simulation::visit_stage(stage, [&](const StageField& field, auto& value) {
    const ordered_json* found = find_field(json, field.name, field.earlier);
    if (found == nullptr && field.is_late) return;
    read(found == nullptr ? json.at(field.name) : *found, value);
  });
}

void add_verdict(const simulation::StageRecord& stage, ordered_json& equilibrium) {
  const bool is_static = stage.stage.kind == StageKind::settle;
  equilibrium["verdict"] = is_static ? ordered_json(simulation::verdict_text(stage)) : ordered_json();
  equilibrium["moving"] = movements_json(stage);
}

}  // namespace keyblock::results
