#include "core/checked_json.h"
#include "hazard/hazard_readers.h"

namespace keyblock::hazard {
namespace {

using nlohmann::json;

/// "SA0P3" is SA(0.3).
std::string intensity_name(const std::string& value) {
  if (!value.starts_with("SA") || value.find('P') == std::string::npos) return value;
  std::string period = value.substr(2);
  period[period.find('P')] = '.';
  const auto number = number_of(period);
  std::string text = number ? json(*number).dump() : period;
  return "SA(" + text + ")";
}

/// That of all sources together.
const json* total_of(const json& data) {
  for (const json& one : data)
    if (one.value("component", "") == "Total") return &one;
  return nullptr;
}

RawHazard read_curve(const HazardText& text, const json& curve) {
  const json& metadata = curve.at("metadata");
  RawHazard raw;
  raw.intensity = intensity_name(metadata.at("imt").at("value").get<std::string>());
  raw.unit = *unit_of(raw.intensity, raw.intensity == "PGV" ? "cm/s" : "g");
  const json* total = total_of(curve.at("data"));
  if (total == nullptr) text.fail(0, "no data of component \"Total\"", "the hazard of all sources together");
  const bool is_new = total->contains("values");
  (is_new ? total->at("values").at("xs") : metadata.at("xvalues")).get_to(raw.numbers);
  (is_new ? total->at("values").at("ys") : total->at("yvalues")).get_to(raw.rates);
  if (raw.numbers.size() != raw.rates.size())
    text.fail(
        0,
        std::to_string(raw.rates.size()) + " rates at " + std::to_string(raw.numbers.size()) + " intensities",
        "a rate at each intensity");
  return raw;
}

}  // namespace

RawHazard read_usgs(const HazardText& text, const HazardOptions& options) {
  try {
    const json document = json::parse(text.content);
    const json& response = document.at("response");
    const json& curves = response.is_object() ? response.at("hazards") : response;
    std::string names;
    for (const json& curve : curves) {
      RawHazard raw = read_curve(text, curve);
      if (raw.intensity == options.intensity || (options.intensity.empty() && curves.size() == 1)) return raw;
      names += (names.empty() ? "" : ", ") + raw.intensity;
    }
    text.fail(
        0, "hazards of " + (names.empty() ? "nothing" : names),
        options.intensity.empty() ? "`intensity` that says which is meant" : "one of " + options.intensity);
  } catch (const json::exception& error) {
    text.fail(0, error.what(), "JSON of the hazard service of the USGS");
  }
}

}  // namespace keyblock::hazard
