#include <fmt/format.h>

#include <cmath>

#include "hazard/hazard_readers.h"

namespace keyblock::hazard {
namespace {

/// m/s² or m/s; the settings must say what a table does not.
double unit_of_table(const HazardText& text, const HazardOptions& options) {
  const std::string settings = options.from.empty() ? "the settings" : options.from;
  if (options.intensity.empty())
    text.fail(0, "a table without the name of its intensity", "`intensity = \"PGA\"` in " + settings);
  const auto unit = unit_of(options.intensity, options.unit);
  if (unit) return *unit;
  text.fail(0, options.unit.empty() ? "a table without a unit" : "the unit " + options.unit,
            options.intensity == "PGV" ? "`unit = \"m/s\"` or \"cm/s\" in " + settings
                                       : "`unit = \"g\"`, \"m/s2\" or \"cm/s2\" in " + settings);
}

char separator_of(std::string_view line) {
  for (const char c : {',', ';', '\t'})
    if (line.find(c) != std::string_view::npos) return c;
  return ' ';
}

double rate_of(const HazardText& text, std::size_t line, double number, std::optional<double> years) {
  if (!years) return number;
  if (number < 0.0 || number > 1.0) text.fail(line, fmt::format("{}", number), "a probability from 0 to 1");
  return rate_of_probability(number, *years);
}

}  // namespace

RawHazard read_table(const HazardText& text, const HazardOptions& options) {
  RawHazard raw{options.intensity, {}, {}, {}, unit_of_table(text, options)};
  const std::vector<std::string_view> lines = text.lines();
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].empty() || lines[k].front() == '#') continue;
    const std::vector<std::string_view> fields = fields_of(lines[k], separator_of(lines[k]));
    const auto x = fields.size() == 2 ? number_of(fields[0]) : std::nullopt;
    const auto number = fields.size() == 2 ? number_of(fields[1]) : std::nullopt;
    const bool has_names = fields.size() == 2 && !x && !number && raw.numbers.empty();
    if (has_names) continue;
    if (!x || !number)
      text.fail(k + 1, std::string(lines[k]), "two numbers: intensity, and rate or probability");
    raw.numbers.push_back(*x);
    raw.rates.push_back(rate_of(text, k + 1, *number, options.investigation_time));
    raw.lines.push_back(k + 1);
  }
  return raw;
}

}  // namespace keyblock::hazard
