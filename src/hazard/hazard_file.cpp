#include "hazard/hazard_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/read_file.h"
#include "core/text.h"
#include "hazard/hazard_readers.h"

namespace keyblock::hazard {
namespace {

constexpr double gravity = 9.80665;  // m/s²
constexpr double largest_probability = 0.9999;
constexpr std::size_t least_points = 3;
constexpr std::size_t longest_found = 60;  // characters

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool is_velocity(const std::string& intensity) {
  return intensity == "PGV";
}

/// Without points that hold no rate, and without zeros at the end.
HazardFile checked(const HazardText& text, const RawHazard& raw) {
  HazardFile hazard{raw.intensity, {}};
  statistics::HazardCurve& curve = hazard.curve;
  const auto line_of = [&](std::size_t k) { return k < raw.lines.size() ? raw.lines[k] : 0; };
  double last = 0.0, last_rate = HUGE_VAL;
  for (std::size_t k = 0; k < raw.numbers.size(); ++k) {
    const double x = raw.numbers[k], rate = raw.rates[k];
    if (!(x > last))
      text.fail(line_of(k), fmt::format("the intensity {} after {}", x, last),
                "intensities above 0 that ascend");
    last = x;
    if (std::isnan(rate)) continue;
    if (rate < 0.0) text.fail(line_of(k), fmt::format("the rate {} at {}", rate, x), "a rate of at least 0");
    if (rate > last_rate)
      text.fail(line_of(k), fmt::format("the rate {} at {}, after {}", rate, x, last_rate),
                "rates that do not rise with the intensity");
    last_rate = rate;
    if (rate == 0.0) {
      if (!curve.end) curve.end = x * raw.unit;
      continue;
    }
    curve.intensity.push_back(x * raw.unit);
    curve.rate.push_back(rate);
  }
  if (curve.rate.size() < least_points)
    text.fail(0, fmt::format("{} points with a rate above 0", curve.rate.size()),
              fmt::format("at least {} points of a hazard curve", least_points));
  return hazard;
}

}  // namespace

std::vector<std::string_view> HazardText::lines() const {
  std::vector<std::string_view> found;
  std::string_view rest = content;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    found.push_back(trimmed(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return found;
}

void HazardText::fail(std::size_t line, const std::string& found, std::string expected,
                      std::string hint) const {
  Diagnostic diagnostic;
  diagnostic.where.file = file;
  diagnostic.where.line = static_cast<int>(line);
  diagnostic.where.column = line > 0 ? 1 : 0;
  diagnostic.found = printable(found, 2 * longest_found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

double rate_of_probability(double p, double years) {
  return p < largest_probability ? -std::log1p(-p) / years : std::nan("");
}

std::optional<double> number_of(std::string_view text) {
  text = trimmed(text);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = line.find(separator);
    const std::string_view field = trimmed(line.substr(0, end));
    if (separator == ',' || !field.empty()) fields.push_back(field);
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> unit_of(const std::string& intensity, const std::string& unit) {
  if (is_velocity(intensity))
    return unit == "m/s" ? std::optional(1.0) : unit == "cm/s" ? std::optional(0.01) : std::nullopt;
  if (unit == "g") return gravity;
  if (unit == "m/s2" || unit == "m/s²") return 1.0;
  return unit == "cm/s2" || unit == "gal" ? std::optional(0.01) : std::nullopt;
}

HazardFile read_hazard(const std::filesystem::path& file, const HazardOptions& options) {
  const HazardText text{file.string(), read_file(file)};
  const std::size_t first = text.content.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos) text.fail(0, "an empty file", "a hazard curve");
  const bool is_json = text.content[first] == '{' || text.content[first] == '[';
  const std::string head = text.content.substr(0, text.content.find('\n'));
  const bool is_openquake =
      head.find("imt=") != std::string::npos || head.find("investigation_time=") != std::string::npos;
  const RawHazard raw = is_json        ? read_usgs(text, options)
                        : is_openquake ? read_openquake(text, options)
                                       : read_table(text, options);
  if (!options.intensity.empty() && raw.intensity != options.intensity)
    text.fail(0, fmt::format("a hazard of {}", raw.intensity),
              fmt::format("one of {}, as {} says", options.intensity, options.from));
  return checked(text, raw);
}

}  // namespace keyblock::hazard
