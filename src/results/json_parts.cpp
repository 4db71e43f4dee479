#include "results/json_parts.h"

#include <cmath>
#include <string_view>

#include "core/checked_json.h"
#include "record/damage_fields.h"
#include "record/fallen.h"
#include "record/record_fields.h"
#include "record/standing.h"
#include "record/verdict.h"

namespace keyblock::results {

using nlohmann::ordered_json;

/// "group.name" is `name` of the object `group`.
static const ordered_json* find_named(const ordered_json& json, std::string_view name) {
  const std::size_t point = name.find('.');
  const auto found = json.find(std::string(name.substr(0, point)));
  if (found == json.end()) return nullptr;
  return point == std::string_view::npos ? &*found : find_named(*found, name.substr(point + 1));
}

const ordered_json* find_field(const ordered_json& json, const char* name, const char* earlier) {
  const ordered_json* found = find_named(json, name);
  return found == nullptr && earlier != nullptr ? find_named(json, earlier) : found;
}

double number(const ordered_json& value) {
  return value.is_null() ? std::nan("") : value.get<double>();
}

ordered_json or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}
ordered_json or_null(const std::optional<int>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json number_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json damage_json(const record::Damage& damage) {
  ordered_json json;
  record::for_damage_fields([&](const auto& field) { json[field.name] = damage.*field.number; });
  return json;
}

ordered_json damage_measures_json() {
  constexpr std::pair<record::DamageTable, const char*> tables[] = {
      {record::DamageTable::none, nullptr},
      {record::DamageTable::rock, "rock"},
      {record::DamageTable::joints, "joints"},
      {record::DamageTable::elements, "elements"}};
  ordered_json all = ordered_json::array();
  record::for_damage_fields([&](const auto& field) {
    const char* table = tables[static_cast<std::size_t>(field.column.table)].second;
    if (table == nullptr) return;
    all.push_back({{"name", field.name},
                   {"table", table},
                   {"title", field.column.title},
                   {"unit", field.shown.unit},
                   {"factor", field.shown.factor},
                   {"decimals", field.column.decimals},
                   {"known_with", field.known_with == nullptr ? field.name : field.known_with}});
  });
  return all;
}

record::Damage read_damage(const ordered_json& json) {
  record::Damage damage;
  // Files of earlier versions have fewer.
  for (const auto& field : record::damage_counts)
    if (json.contains(field.name)) json.at(field.name).get_to(damage.*field.number);
  for (const auto& field : record::damage_fields)
    damage.*field.number = json.contains(field.name) ? number(json.at(field.name)) : std::nan("");
  return damage;
}

ordered_json fallen_json(const std::vector<record::FallenBlock>& fallen) {
  ordered_json json = ordered_json::array();
  for (const auto& f : fallen) {
    const char* part = record::wall_part_name(f.part);
    json.push_back({{"block", f.block},
                    {"area_m2", f.area},
                    {"weight_n_m", f.weight},
                    {"depth_m", f.depth},
                    {"wall", part == nullptr ? ordered_json() : ordered_json(part)}});
  }
  return json;
}

std::vector<record::FallenBlock> read_fallen(const ordered_json& json) {
  std::vector<record::FallenBlock> fallen;
  for (const auto& f : json) {
    const ordered_json& part = f.at("wall");
    fallen.push_back(
        {f.at("block").get<int>(), number(f.at("area_m2")), number(f.at("weight_n_m")),
         number(f.at("depth_m")),
         part.is_null() ? record::WallPart::none : record::wall_part_of(part.get<std::string>())});
  }
  return fallen;
}

ordered_json wait_json(const std::optional<record::StageWait>& wait) {
  if (!wait) return nullptr;
  return {{"what", wait->what}, {"until_s", wait->until}};
}

std::optional<record::StageWait> read_wait(const ordered_json& json) {
  if (json.is_null()) return std::nullopt;
  return record::StageWait{number(json.at("until_s")), json.at("what").get<std::string>()};
}

ordered_json planes_json(const std::vector<record::PlaneRecord>& planes, Vec2 origin) {
  ordered_json json = ordered_json::array();
  for (const record::PlaneRecord& p : planes)
    json.push_back({{"joint", p.joint},
                    {"x", p.x + origin.x},
                    {"height_m", p.height + origin.y},
                    {"dip_deg", p.dip},
                    {"mobilized", std::isfinite(p.mobilized) ? ordered_json(p.mobilized) : ordered_json()},
                    {"normal_stress_pa", p.normal},
                    {"shear_stress_pa", p.shear},
                    {"slip_m", p.slip},
                    {"slip_max_m", p.slip_max},
                    {"opened", p.opened}});
  return json;
}

std::vector<record::PlaneRecord> read_planes(const ordered_json& json) {
  std::vector<record::PlaneRecord> planes;
  for (const ordered_json& p : json)
    planes.push_back({.joint = p.at("joint").get<std::string>(),
                      .x = p.at("x").get<double>(),
                      .height = p.at("height_m").get<double>(),
                      .dip = p.at("dip_deg").get<double>(),
                      .mobilized = p.at("mobilized").is_null() ? HUGE_VAL : p.at("mobilized").get<double>(),
                      .normal = p.at("normal_stress_pa").get<double>(),
                      .shear = p.at("shear_stress_pa").get<double>(),
                      .slip = p.at("slip_m").get<double>(),
                      .slip_max = p.at("slip_max_m").get<double>(),
                      .opened = p.at("opened").get<bool>()});
  return planes;
}

ordered_json standing_json(const std::optional<record::Standing>& standing) {
  return standing ? ordered_json(record::standing_name(*standing)) : ordered_json();
}

std::optional<record::Standing> read_standing(const ordered_json& json) {
  for (const record::StandingWord& word : record::standing_words())
    if (json == word.name) return word.standing;
  return std::nullopt;
}

ordered_json movers_json(const record::Movers& movers) {
  return {{"blocks", movers.blocks},
          {"weight_n_m", movers.weight},
          {"heaviest", movers.heaviest < 0 ? ordered_json() : ordered_json(movers.heaviest)},
          {"heaviest_weight_n_m", movers.heaviest_weight},
          {"way_m", movers.way}};
}

record::Movers read_movers(const ordered_json& json) {
  const ordered_json& heaviest = json.at("heaviest");
  return {json.at("blocks").get<int>(), heaviest.is_null() ? -1 : heaviest.get<int>(),
          number(json.at("weight_n_m")), number(json.at("heaviest_weight_n_m")), number(json.at("way_m"))};
}

ordered_json energy_json(const record::Energy& energy) {
  ordered_json json;
  for (const record::EnergyField& field : record::energy_fields) json[field.name] = energy.*field.number;
  return json;
}

record::Energy read_energy(const ordered_json& json) {
  record::Energy energy;
  for (const record::EnergyField& field : record::energy_fields)
    if (!field.is_late || json.contains(field.name)) energy.*field.number = number(json.at(field.name));
  return energy;
}

ordered_json moving_json(const std::vector<record::MovingBlock>& moving) {
  ordered_json json = ordered_json::array();
  for (const auto& m : moving)
    json.push_back({{"block", m.block}, {"carried", m.carried}, {"group", m.group}});
  return json;
}

ordered_json movements_json(const record::StageRecord& stage) {
  ordered_json json = moving_json(stage.moving);
  for (std::size_t k = 0; k < stage.moving.size(); ++k)
    json[k]["movement"] = record::movement_name(record::movement_of(stage, k));
  return json;
}

std::vector<record::MovingBlock> read_moving(const ordered_json& json) {
  std::vector<record::MovingBlock> moving;
  for (const auto& m : json) {
    const int block = m.at("block").get<int>();
    moving.push_back(
        {block, number(m.at("carried")), m.value("group", block)});  // no group in files of version 0.1
  }
  return moving;
}

ordered_json release_json(const std::vector<record::ReleasePoint>& points,
                          const std::vector<std::string>& excavations) {
  ordered_json list = ordered_json::array();
  for (const record::ReleasePoint& p : points) {
    const auto e = static_cast<std::size_t>(p.excavation);
    const ordered_json excavation =
        e < excavations.size() ? ordered_json(excavations[e]) : ordered_json(p.excavation);
    list.push_back({{"excavation", excavation},
                    {"step", p.step},
                    {"released", p.released},
                    {"crown_m", p.crown},
                    {"springline_m", p.springline},
                    {"mean_m", p.mean}});
  }
  return list;
}

ordered_json open_close_json(const record::OpenCloseStatistics& statistics) {
  return {{"mean_iterations", statistics.mean_iterations},
          {"max_iterations", statistics.max_iterations},
          {"retried_steps", statistics.retried_steps},
          {"unconverged_steps", statistics.unconverged_steps}};
}

std::vector<record::ReleasePoint> read_release(const ordered_json& json) {
  std::vector<record::ReleasePoint> points;
  for (const auto& p : json)
    points.push_back({p.at("step").get<long>(), number(p.at("released")), number(p.at("crown_m")),
                      number(p.at("springline_m")), number(p.at("mean_m")), p.at("excavation").get<int>()});
  return points;
}

record::OpenCloseStatistics read_open_close(const ordered_json& json) {
  record::OpenCloseStatistics statistics;
  statistics.mean_iterations = number(json.at("mean_iterations"));
  json.at("max_iterations").get_to(statistics.max_iterations);
  json.at("retried_steps").get_to(statistics.retried_steps);
  json.at("unconverged_steps").get_to(statistics.unconverged_steps);
  return statistics;
}

ordered_json ground_json(const std::vector<std::pair<std::string, std::string>>& ground) {
  ordered_json json = ordered_json::array();
  for (const auto& [name, value] : ground) json.push_back({{"name", name}, {"value", value}});
  return json;
}

std::vector<std::pair<std::string, std::string>> read_ground(const ordered_json& json) {
  std::vector<std::pair<std::string, std::string>> ground;
  for (const auto& fact : json)
    ground.emplace_back(fact.at("name").get<std::string>(), fact.at("value").get<std::string>());
  return ground;
}

ordered_json overlap_place_json(const record::OverlapRecord& overlap, Vec2 origin) {
  if (overlap.block_a < 0) return nullptr;
  const Vec2 where = origin + overlap.where;
  return {{"blocks", {overlap.block_a, overlap.block_b}},
          {"x", where.x},
          {"y", where.y},
          {"time_s", overlap.time},
          {"stage", overlap.stage}};
}

/// A distance and its place under NAME_m and NAME_at.
static void add_place(ordered_json& json, const std::string& name, const record::OverlapRecord& place,
                      Vec2 origin) {
  json[name + "_m"] = place.depth;
  json[name + "_at"] = overlap_place_json(place, origin);
}

static record::OverlapRecord read_place(const ordered_json& json, const std::string& name) {
  record::OverlapRecord place;
  place.depth = number(json.at(name + "_m"));
  read_overlap_place(json.at(name + "_at"), place);
  return place;
}

ordered_json contact_checks_json(const record::ContactChecks& vertices, Vec2 origin) {
  ordered_json json{{"across_gaps", vertices.across_gaps}};
  add_place(json, "farthest", vertices.farthest, origin);
  add_place(json, "deepest", vertices.deepest, origin);
  add_place(json, "unexplained", vertices.unexplained, origin);
  return json;
}

record::ContactChecks read_contact_checks(const ordered_json& json) {
  record::ContactChecks vertices;
  json.at("across_gaps").get_to(vertices.across_gaps);
  vertices.farthest = read_place(json, "farthest");
  vertices.deepest = read_place(json, "deepest");
  vertices.unexplained = read_place(json, "unexplained");
  return vertices;
}

void read_overlap_place(const ordered_json& json, record::OverlapRecord& overlap) {
  if (json.is_null()) return;
  json.at("blocks").at(0).get_to(overlap.block_a);
  json.at("blocks").at(1).get_to(overlap.block_b);
  overlap.where = {number(json.at("x")), number(json.at("y"))};
  overlap.time = number(json.at("time_s"));
  json.at("stage").get_to(overlap.stage);
}

ordered_json points_json(const std::vector<Vec2>& points) {
  ordered_json json = ordered_json::array();
  for (const Vec2 p : points) json.push_back({p.x, p.y});
  return json;
}

std::vector<Vec2> read_points(const ordered_json& json) {
  std::vector<Vec2> points;
  for (const auto& p : json) points.push_back({number(p.at(0)), number(p.at(1))});
  return points;
}

}  // namespace keyblock::results
