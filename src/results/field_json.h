#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/checked_json.h"
#include "record/record.h"
#include "results/json_parts.h"

/// Values of the fields that tables of records describe, to JSON and back. For the sources of this folder: the header is heavy.
namespace keyblock::results {

nlohmann::ordered_json json_of(record::StageKind kind);
nlohmann::ordered_json json_of(const std::optional<record::StageWait>& wait);
nlohmann::ordered_json json_of(const std::optional<record::Standing>& standing);
nlohmann::ordered_json json_of(const record::Movers& movers);
nlohmann::ordered_json json_of(const record::Damage& damage);
nlohmann::ordered_json json_of(const record::Energy& energy);
nlohmann::ordered_json json_of(const record::OpenCloseStatistics& statistics);
nlohmann::ordered_json json_of(const std::vector<record::MovingBlock>& moving);
nlohmann::ordered_json json_of(const std::vector<record::FallenBlock>& fallen);
nlohmann::ordered_json json_of(const std::vector<record::ReleasePoint>& release);
nlohmann::ordered_json json_of(const std::vector<Vec2>& points);
template <class T>
nlohmann::ordered_json json_of(const std::optional<T>& value) {
  return or_null(value);
}
template <class T>
nlohmann::ordered_json json_of(const T& value) {
  return value;
}

void read(const nlohmann::ordered_json& json, double& value);
void read(const nlohmann::ordered_json& json, record::StageKind& value);
void read(const nlohmann::ordered_json& json, std::optional<record::StageWait>& value);
void read(const nlohmann::ordered_json& json, std::optional<record::Standing>& value);
void read(const nlohmann::ordered_json& json, record::Movers& value);
void read(const nlohmann::ordered_json& json, record::Damage& value);
void read(const nlohmann::ordered_json& json, record::Energy& value);
void read(const nlohmann::ordered_json& json, record::OpenCloseStatistics& value);
void read(const nlohmann::ordered_json& json, std::vector<record::MovingBlock>& value);
void read(const nlohmann::ordered_json& json, std::vector<record::FallenBlock>& value);
void read(const nlohmann::ordered_json& json, std::vector<record::ReleasePoint>& value);
void read(const nlohmann::ordered_json& json, std::vector<double>& value);
void read(const nlohmann::ordered_json& json, std::vector<Vec2>& value);
template <class T>
void read(const nlohmann::ordered_json& json, std::optional<T>& value) {
  value = json.is_null() ? std::nullopt : std::optional(json.get<T>());
}
template <class T>
void read(const nlohmann::ordered_json& json, T& value) {
  json.get_to(value);
}

/// A field that a table describes, by its name, or by its earlier one. What only later files have stays as it is where it is not there.
template <class Field, class T>
void read_field(const nlohmann::ordered_json& json, const Field& field, T& value) {
  const nlohmann::ordered_json* found = find_field(json, field.name, field.earlier);
  if (found == nullptr && field.is_late) return;
  read(found == nullptr ? json.at(field.name) : *found, value);
}

}  // namespace keyblock::results
