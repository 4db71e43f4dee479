#include "results/field_json.h"

#include <utility>

#include "results/stage_json.h"

namespace keyblock::results {

using nlohmann::ordered_json;
using record::StageKind;

namespace {
constexpr std::pair<StageKind, const char*> kinds[] = {
    {StageKind::settle, "settle"}, {StageKind::shake, "shake"}, {StageKind::rest, "rest"}};
}  // namespace

std::string stage_kind_name(StageKind kind) {
  for (const auto& [known, name] : kinds) {
    if (known == kind) return name;
  }
  return {};
}

ordered_json json_of(StageKind kind) {
  return stage_kind_name(kind);
}
ordered_json json_of(const std::optional<record::StageWait>& wait) {
  return wait_json(wait);
}
ordered_json json_of(const std::optional<record::Standing>& standing) {
  return standing_json(standing);
}
ordered_json json_of(const record::Movers& movers) {
  return movers_json(movers);
}
ordered_json json_of(const record::Damage& damage) {
  return damage_json(damage);
}
ordered_json json_of(const record::Energy& energy) {
  return energy_json(energy);
}
ordered_json json_of(const record::OpenCloseStatistics& statistics) {
  return open_close_json(statistics);
}
ordered_json json_of(const std::vector<record::MovingBlock>& moving) {
  return moving_json(moving);
}
ordered_json json_of(const std::vector<record::FallenBlock>& fallen) {
  return fallen_json(fallen);
}
ordered_json json_of(const std::vector<record::ReleasePoint>& release) {
  return release_json(release, {});
}
ordered_json json_of(const std::vector<Vec2>& points) {
  return points_json(points);
}

void read(const ordered_json& json, double& value) {
  value = number(json);
}
void read(const ordered_json& json, StageKind& value) {
  for (const auto& [kind, name] : kinds)
    if (json == name) value = kind;
}
void read(const ordered_json& json, std::optional<record::StageWait>& value) {
  value = read_wait(json);
}
void read(const ordered_json& json, std::optional<record::Standing>& value) {
  value = read_standing(json);
}
void read(const ordered_json& json, record::Movers& value) {
  value = read_movers(json);
}
void read(const ordered_json& json, record::Damage& value) {
  value = read_damage(json);
}
void read(const ordered_json& json, record::Energy& value) {
  value = read_energy(json);
}
void read(const ordered_json& json, record::OpenCloseStatistics& value) {
  value = read_open_close(json);
}
void read(const ordered_json& json, std::vector<record::MovingBlock>& value) {
  value = read_moving(json);
}
void read(const ordered_json& json, std::vector<record::FallenBlock>& value) {
  value = read_fallen(json);
}
void read(const ordered_json& json, std::vector<record::ReleasePoint>& value) {
  value = read_release(json);
}
void read(const ordered_json& json, std::vector<Vec2>& value) {
  value = read_points(json);
}
void read(const ordered_json& json, std::vector<double>& value) {
  for (const ordered_json& one : json) value.push_back(number(one));
}

}  // namespace keyblock::results
