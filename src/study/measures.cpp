#include "study/measures.h"

#include <array>

namespace keyblock::study {

namespace {

using simulation::Damage;

const std::array<Measure, 10> all_measures{{
    {"fallen_blocks", "fallen blocks", "",
     [](const Damage& d) { return static_cast<double>(d.fallen_blocks); }},
    {"fallen_area_m2", "fallen area", "m²", [](const Damage& d) { return d.fallen_area; }},
    {"opening_filled_ratio", "filled share of the opening", "",
     [](const Damage& d) { return d.opening_filled_ratio; }},
    {"loosened_area_m2", "loosened area", "m²", [](const Damage& d) { return d.loosened_area; }},
    {"slip_max_m", "largest slip", "m", [](const Damage& d) { return d.slip_max; }},
    {"slip_mean_m", "mean slip", "m", [](const Damage& d) { return d.slip_mean; }},
    {"slipped_length_m", "slipped length", "m", [](const Damage& d) { return d.slipped_length; }},
    {"opened_length_m", "opened length", "m", [](const Damage& d) { return d.opened_length; }},
    {"closure_vertical_m", "vertical closure", "m", [](const Damage& d) { return d.closure_vertical; }},
    {"closure_horizontal_m", "horizontal closure", "m", [](const Damage& d) { return d.closure_horizontal; }},
}};
static_assert(sizeof(Damage) == std::size(all_measures) * sizeof(double),
              "a measure of the damage is missing");

const std::array<Intensity, 3> all_intensities{
    {{"pga_m_s2", "PGA", "m/s²", &StageMeasures::pga},
     {"pgv_m_s", "PGV", "m/s", &StageMeasures::pgv},
     {"arias_m_s", "Arias intensity", "m/s", &StageMeasures::arias}}};

}  // namespace

std::span<const Measure> measures() {
  return all_measures;
}

std::optional<std::size_t> find_measure(std::string_view name) {
  for (std::size_t k = 0; k < all_measures.size(); ++k)
    if (all_measures[k].name == name) return k;
  return std::nullopt;
}

std::span<const Intensity> intensities() {
  return all_intensities;
}

std::string plain_value(std::string_view toml) {
  if (toml.size() >= 2 && (toml.front() == '"' || toml.front() == '\'') && toml.back() == toml.front()) {
    const std::string_view inner = toml.substr(1, toml.size() - 2);
    const bool escapes = inner.find(toml.front()) != std::string_view::npos ||
                         (toml.front() == '"' && inner.find('\\') != std::string_view::npos);
    if (!escapes) return std::string(inner);
  }
  return std::string(toml);
}

}  // namespace keyblock::study
