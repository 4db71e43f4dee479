#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/checked_json.h"
#include "rockmass/trace_map_reader.h"

namespace keyblock::rockmass {
namespace {

using Json = nlohmann::json;

constexpr int most_levels = 32;  // levels of lists and objects

std::string text_of(const Json& value) {
  return shortened(value.dump());
}

// Valid JSON, in which values are found again by their keys.
class JsonText {
 public:
  explicit JsonText(std::string_view text) : text_(text) {}

  // Offset of the value of a key such as `features[3].geometry`, or of the last one on the way that is there.
  [[nodiscard]] std::size_t find(std::string_view key) const {
    std::size_t at = skip_space(text_.starts_with("\xEF\xBB\xBF") ? 3 : 0);
    while (!key.empty()) {
      if (key.front() == '.') key.remove_prefix(1);
      const bool indexed = key.front() == '[';
      const std::size_t end = std::min(indexed ? key.find(']') + 1 : key.find_first_of(".["), key.size());
      const std::string_view step = key.substr(0, end);
      key.remove_prefix(end);
      const std::size_t next = text_[at] != (indexed ? '[' : '{') ? npos : child(at, step);
      if (next == npos) break;
      at = next;
    }
    return at;
  }

  // Offset of the bracket that opens a level below so many, or npos. The text may be anything.
  [[nodiscard]] std::size_t find_deeper_than(int levels) const {
    int depth = 0;
    for (std::size_t at = 0; at < text_.size(); ++at) {
      const char c = text_[at];
      if (c == '"') at = skip_string(at) - 1;
      if ((c == '[' || c == '{') && ++depth > levels) return at;
      if (c == ']' || c == '}') --depth;
    }
    return npos;
  }

  // Offset and text of the first number that a double cannot hold. The text may be anything.
  [[nodiscard]] std::pair<std::size_t, std::string_view> find_huge_number() const {
    for (std::size_t at = 0; at < text_.size(); ++at) {
      if (text_[at] == '"') {
        at = skip_string(at) - 1;
      } else if (text_[at] == '-' || (text_[at] >= '0' && text_[at] <= '9')) {
        const std::string_view number = text_.substr(at, skip_value(at) - at);
        if (!Json::accept(number)) return {at, number};
        at += number.size() - 1;
      }
    }
    return {npos, {}};
  }

 private:
  static constexpr std::size_t npos = std::string_view::npos;

  [[nodiscard]] std::size_t skip_space(std::size_t at) const {
    return std::min(text_.find_first_not_of(" \t\r\n", at), text_.size());
  }

  // The place after a string, a container, a number or a word.
  [[nodiscard]] std::size_t skip_string(std::size_t at) const {
    for (++at; at < text_.size() && text_[at] != '"'; ++at) {
      if (text_[at] == '\\') ++at;
    }
    return std::min(at + 1, text_.size());
  }
  [[nodiscard]] std::size_t skip_value(std::size_t at) const {
    constexpr std::string_view ends = ",]} \t\r\n";
    int depth = 0;
    do {
      const char c = text_[at];
      depth += (c == '[' || c == '{') - (c == ']' || c == '}');
      at = c == '"' ? skip_string(at) : at + 1;
    } while (at < text_.size() && (depth > 0 || ends.find(text_[at]) == std::string_view::npos));
    return at;
  }

  // Of the list or object at `at`, the value at `[3]` or of a member.
  [[nodiscard]] std::size_t child(std::size_t at, std::string_view step) const {
    std::string counted;
    for (std::size_t k = 0;; ++k) {
      at = skip_space(at + 1);
      if (at >= text_.size() || text_[at] == ']' || text_[at] == '}') return npos;
      std::string_view name;
      if (step.front() == '[') {
        counted = fmt::format("[{}]", k);
        name = counted;
      } else {
        const std::size_t end = skip_string(at);
        name = text_.substr(at + 1, end - at - 2);
        at = skip_space(skip_space(end) + 1);
      }
      if (name == step) return at;
      at = skip_space(skip_value(at));
      if (at >= text_.size() || text_[at] != ',') return npos;
    }
  }

  std::string_view text_;
};

class GeoJsonReader {
 public:
  GeoJsonReader(std::string_view text, MapReader& map) : text_(text), map_(map) {}

  void object(const Json& value, const std::string& key) {
    const std::string type =
        value.is_object()
            ? value.value("type", Json()).is_string() ? value["type"].get<std::string>() : std::string()
            : std::string();
    if (type == "FeatureCollection") {
      members(value, key, "features");
    } else if (type == "GeometryCollection") {
      members(value, key, "geometries");
    } else if (type == "Feature") {
      map_.set_strength(strength_of(value, key));
      if (const auto geometry = value.find("geometry"); geometry != value.end() && !geometry->is_null()) {
        object(*geometry, join(key, "geometry"));
      }
      map_.set_strength({});
    } else if (type == "LineString") {
      line(value, join(key, "coordinates"));
    } else if (type == "MultiLineString") {
      lines(value, join(key, "coordinates"));
    } else {
      mistake(join(key, "type"), type.empty() ? text_of(value) : '"' + type + '"',
              "LineString or MultiLineString, alone or in a Feature or FeatureCollection");
    }
  }

 private:
  static std::string join(const std::string& key, const std::string& member) {
    return key.empty() ? member : key + '.' + member;
  }

  /// By the properties of a feature.
  TraceStrength strength_of(const Json& feature, const std::string& key) {
    TraceStrength strength;
    const auto properties = feature.find("properties");
    if (properties == feature.end() || !properties->is_object()) return strength;
    for (std::size_t k = 0; k < strength_count; ++k) {
      const auto found = properties->find(strength_names[k]);
      if (found == properties->end() || found->is_null()) continue;
      const auto name = static_cast<StrengthKey>(k);
      if (found->is_number() && is_strength(name, found->get<double>())) {
        strength[k] = found->get<double>();
      } else {
        mistake(join(join(key, "properties"), strength_names[k]), text_of(*found), strength_expected(name));
      }
    }
    return strength;
  }

  void members(const Json& value, const std::string& key, const char* name) {
    const auto list = value.find(name);
    if (list == value.end() || !list->is_array()) {
      mistake(join(key, name), list == value.end() ? "nothing" : text_of(*list), "a list");
      return;
    }
    for (std::size_t k = 0; k < list->size(); ++k)
      object((*list)[k], fmt::format("{}[{}]", join(key, name), k));
  }

  void lines(const Json& value, const std::string& key) {
    const auto list = value.find("coordinates");
    if (list == value.end() || !list->is_array()) {
      mistake(key, list == value.end() ? "nothing" : text_of(*list), "a list of lines");
      return;
    }
    for (std::size_t k = 0; k < list->size(); ++k) vertices((*list)[k], fmt::format("{}[{}]", key, k));
  }

  void line(const Json& value, const std::string& key) {
    const auto list = value.find("coordinates");
    vertices(list == value.end() ? Json() : *list, key);
  }

  void vertices(const Json& list, const std::string& key) {
    if (!list.is_array() || list.empty()) {
      mistake(key, text_of(list), "a list of [x, y]");
      return;
    }
    std::vector<Vec2> points;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Json& p = list[k];
      if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number()) {
        mistake(fmt::format("{}[{}]", key, k), text_of(p), "[x, y], two finite numbers");
        return;
      }
      points.push_back({p[0].get<double>(), p[1].get<double>()});
    }
    if (auto found = map_.add(points)) mistake(key, std::move(*found), MapReader::trace_expected);
  }

  void mistake(const std::string& key, std::string found, std::string expected) {
    if (map_.is_full()) return;
    const auto [line, column] = line_and_column(text_, JsonText(text_).find(key));
    map_.mistake(line, column, key, std::move(found), std::move(expected));
  }

  std::string_view text_;
  MapReader& map_;
};

// The member `crs` of GeoJSON before RFC 7946, by name or by the number of EPSG.
void name_system(const Json& root, std::string_view text, MapReader& map) {
  if (!root.is_object()) return;
  for (const char* member : {"name", "code"}) {
    const Json value = root.value(Json::json_pointer(std::string("/crs/properties/") + member), Json());
    if (!value.is_string() && !value.is_number_integer()) continue;
    const std::string key = std::string("crs.properties.") + member;
    const auto [line, column] = line_and_column(text, JsonText(text).find(key));
    map.names_system(line, column, key,
                     value.is_string() ? value.get<std::string>() : "EPSG:" + value.dump());
  }
}

}  // namespace

void read_geojson(std::string_view text, MapReader& map) {
  if (const std::size_t at = JsonText(text).find_deeper_than(most_levels); at != std::string_view::npos) {
    const auto [line, column] = line_and_column(text, at);
    map.mistake(line, column, "", fmt::format("more than {} levels of lists and objects", most_levels),
                "GeoJSON, which needs fewer than ten");
    return;
  }
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto [line, column] = line_and_column(text, error.byte > 0 ? error.byte - 1 : 0);
    map.mistake(line, column, "", "text that is no JSON", "GeoJSON");
    return;
  } catch (const Json::out_of_range&) {
    const auto [at, number] = JsonText(text).find_huge_number();
    const auto [line, column] = line_and_column(text, at);
    map.mistake(line, column, "", shortened(number), "a finite number");
    return;
  }
  name_system(root, text, map);
  GeoJsonReader(text, map).object(root, "");
}

}  // namespace keyblock::rockmass
