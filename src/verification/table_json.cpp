#include <cmath>

#include "core/checked_json.h"
#include "verification/report.h"

namespace keyblock::verification {
namespace {

using nlohmann::ordered_json;

ordered_json number(const std::optional<double>& x) {
  return x && std::isfinite(*x) ? ordered_json(*x) : ordered_json(nullptr);
}

// A value as TOML where JSON reads the same; text otherwise.
ordered_json parameter(const std::string& toml) {
  ordered_json value = ordered_json::parse(toml, nullptr, false);
  return value.is_discarded() ? ordered_json(toml) : value;
}

ordered_json row_json(const CaseFile& file, const Row& row) {
  ordered_json parameters = ordered_json::object();
  for (const auto& [key, value] : row.parameters) parameters[key] = parameter(value);
  ordered_json json{{"name", file.name},
                    {"case", file.number},
                    {"quantity", row.quantity},
                    {"unit", row.unit},
                    {"run", row.run},
                    {"order", row.order ? ordered_json(*row.order) : ordered_json(nullptr)},
                    {"parameters", parameters},
                    {"computed", number(row.computed)},
                    {"expected", number(row.expected)},
                    {"relative_error", number(row.relative_error)},
                    {"published_dda", number(row.published)},
                    {"source", row.source},
                    {"tolerance", number(row.tolerance)},
                    {"absolute_tolerance", number(row.absolute_tolerance)},
                    {"pass", row.pass},
                    {"wall_time_s", row.wall_time}};
  if (row.at_most) json["at_most"] = number(row.at_most);
  if (row.at_least) json["at_least"] = number(row.at_least);
  if (!row.failure.empty()) json["failure"] = row.failure;
  return json;
}

}  // namespace

std::string table_json(const std::vector<CaseResult>& results, const std::string& version) {
  ordered_json cases = ordered_json::array(), rows = ordered_json::array();
  int failed = 0;
  double wall_time = 0.0;
  for (const CaseResult& result : results) {
    if (result.rows.empty()) continue;
    const CaseFile& file = *result.file;
    failed += result.failed();
    wall_time += result.wall_time;
    cases.push_back({{"name", file.name},
                     {"case", file.number},
                     {"title", file.title},
                     {"about", file.about},
                     {"rows", result.rows.size()},
                     {"failed", result.failed()},
                     {"wall_time_s", result.wall_time}});
    for (const Row& row : result.rows) rows.push_back(row_json(file, row));
  }
  const ordered_json json{{"version", version}, {"passed", static_cast<int>(rows.size()) - failed},
                          {"failed", failed},   {"wall_time_s", wall_time},
                          {"cases", cases},     {"rows", rows}};
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace keyblock::verification
