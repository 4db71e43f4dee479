#include <fmt/format.h>

#include <cmath>

#include "hazard/hazard_readers.h"

namespace keyblock::hazard {

RawHazard read_table(const HazardText& text, const HazardOptions& options) {
  const std::string settings = options.from.empty() ? "the settings" : options.from;
  if (options.intensity.empty())
    text.fail(0, "a table without the name of its intensity", "`intensity = \"PGA\"` in " + settings);
  const auto unit = unit_of(options.intensity, options.unit);
  if (!unit)
    text.fail(0, options.unit.empty() ? "a table without a unit" : "the unit " + options.unit,
              options.intensity == "PGV" ? "`unit = \"m/s\"` or \"cm/s\" in " + settings
                                         : "`unit = \"g\"`, \"m/s2\" or \"cm/s2\" in " + settings);
  RawHazard raw{options.intensity, {}, {}, {}, *unit};
  const std::vector<std::string_view> lines = text.lines();
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].empty() || lines[k].front() == '#') continue;
    const std::string_view line = lines[k];
    const char separator = line.find(',') != std::string_view::npos    ? ','
                           : line.find(';') != std::string_view::npos  ? ';'
                           : line.find('\t') != std::string_view::npos ? '\t'
                                                                       : ' ';
    const std::vector<std::string_view> fields = fields_of(line, separator);
    const auto x = number_of(fields.front());
    if (!x && raw.numbers.empty() && fields.size() == 2) continue;  // names of the columns
    const auto rate = fields.size() == 2 ? number_of(fields[1]) : std::nullopt;
    if (!x || !rate) text.fail(k + 1, std::string(line), "two numbers: intensity, and rate or probability");
    const bool is_probability = options.investigation_time.has_value();
    if (is_probability && (*rate < 0.0 || *rate > 1.0))
      text.fail(k + 1, std::string(fields[1]), "a probability from 0 to 1");
    raw.numbers.push_back(*x);
    raw.rates.push_back(is_probability ? rate_of_probability(*rate, *options.investigation_time) : *rate);
    raw.lines.push_back(k + 1);
  }
  return raw;
}

}  // namespace keyblock::hazard
