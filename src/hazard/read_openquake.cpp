#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hazard/hazard_readers.h"

namespace keyblock::hazard {
namespace {

constexpr double nearest_site = 0.01;  // degrees

/// The value of `name='value'` or `name=value` in the line of comment; empty: it is not there.
std::string value_of(std::string_view line, const std::string& name) {
  const std::size_t at = line.find(name + "=");
  if (at == std::string_view::npos) return {};
  std::string_view rest = line.substr(at + name.size() + 1);
  const bool quoted = !rest.empty() && rest.front() == '\'';
  if (quoted) rest.remove_prefix(1);
  return std::string(rest.substr(0, rest.find_first_of(quoted ? "'" : ", \"")));
}

struct Site {
  std::size_t line;  // from 1
  std::vector<std::string_view> fields;
  double lon, lat;
};

std::vector<Site> read_sites(const HazardText& text, const std::vector<std::string_view>& lines,
                             std::size_t columns) {
  std::vector<Site> sites;
  for (std::size_t k = 2; k < lines.size(); ++k) {
    if (lines[k].empty()) continue;
    std::vector<std::string_view> fields = fields_of(lines[k], ',');
    if (fields.size() != columns)
      text.fail(k + 1, fmt::format("{} fields", fields.size()), fmt::format("{}, as in the header", columns));
    const auto lon = number_of(fields[0]), lat = number_of(fields[1]);
    if (!lon || !lat)
      text.fail(k + 1, fmt::format("'{}', '{}'", fields[0], fields[1]), "longitude and latitude of a site");
    sites.push_back({k + 1, std::move(fields), *lon, *lat});
  }
  if (sites.empty()) text.fail(0, "no site", "a row for each site after the header");
  return sites;
}

const Site& chosen_site(const HazardText& text, const std::vector<Site>& sites,
                        const HazardOptions& options) {
  if (!options.site) {
    if (sites.size() == 1) return sites.front();
    text.fail(0, fmt::format("{} sites", sites.size()), "`site = [lon, lat]` that says which is meant");
  }
  const auto [lon, lat] = *options.site;
  const auto distance = [lon = lon, lat = lat](const Site& s) {
    return std::max(std::abs(s.lon - lon), std::abs(s.lat - lat));
  };
  const auto nearest = std::min_element(
      sites.begin(), sites.end(), [&](const Site& a, const Site& b) { return distance(a) < distance(b); });
  if (distance(*nearest) > nearest_site)
    text.fail(0, fmt::format("no site at [{}, {}]", lon, lat), fmt::format("a site within {}°", nearest_site),
              fmt::format("the nearest is [{}, {}]", nearest->lon, nearest->lat));
  return *nearest;
}

}  // namespace

RawHazard read_openquake(const HazardText& text, const HazardOptions& options) {
  const std::vector<std::string_view> lines = text.lines();
  RawHazard raw;
  raw.intensity = value_of(lines[0], "imt");
  const auto years = number_of(value_of(lines[0], "investigation_time"));
  if (raw.intensity.empty()) text.fail(1, "no imt", "imt='PGA' in the line of comment");
  if (!years || *years <= 0.0)
    text.fail(1, "no investigation_time", "investigation_time=50.0 in the line of comment");
  if (const std::string kind = value_of(lines[0], "kind");
      kind.starts_with("quantile") || kind.starts_with("fractile"))
    text.fail(1, fmt::format("kind='{}'", kind), "the mean, or a branch of the logic tree",
              "a fractile is no hazard: rates of many are not added up");
  raw.unit = *unit_of(raw.intensity, raw.intensity == "PGV" ? "cm/s" : "g");
  if (lines.size() < 2) text.fail(0, "no header", "lon,lat,depth,poe-LEVEL,…");
  const std::vector<std::string_view> header = fields_of(lines[1], ',');
  const std::vector<Site> sites = read_sites(text, lines, header.size());
  const Site& site = chosen_site(text, sites, options);
  for (std::size_t c = 0; c < header.size(); ++c) {
    if (!header[c].starts_with("poe-")) continue;
    const auto level = number_of(header[c].substr(4)), poe = number_of(site.fields[c]);
    if (!level) text.fail(2, std::string(header[c]), "poe- and an intensity");
    if (!poe || *poe < 0.0 || *poe > 1.0)
      text.fail(site.line, std::string(site.fields[c]), "a probability from 0 to 1");
    raw.numbers.push_back(*level);
    raw.rates.push_back(rate_of_probability(*poe, *years));
    raw.lines.push_back(site.line);
  }
  return raw;
}

}  // namespace keyblock::hazard
