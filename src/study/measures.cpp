#include "study/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "record/damage_fields.h"
#include "record/fallen.h"

namespace keyblock::study {

namespace {

/// Differences are taken to this many per unit: far below what a measure means, far above its rounding.
constexpr double difference_grain = 1e9;
constexpr double largest_rounded = 1e6;  ///< beyond, the grain is finer than the numbers themselves

/// a − b, where equal differences of different numbers come out equal, and those of equal numbers as 0.
double difference(double a, double b) {
  const double d = a - b;
  return std::abs(d) < largest_rounded ? std::round(d * difference_grain) / difference_grain + 0.0 : d;
}

const std::array<Intensity, 3> all_intensities{
    {{"pga_m_s2", "PGA", "m/s²", &StageMeasures::pga, 1},
     {"pgv_m_s", "PGV", "m/s", &StageMeasures::pgv, 1},
     {"arias_m_s", "Arias intensity", "m/s", &StageMeasures::arias, 2}}};

}  // namespace

double Measure::of(const record::Damage& damage) const {
  return record::damage_value(damage, name);
}

std::span<const Measure> measures() {
  static const std::vector<Measure> all = [] {
    std::vector<Measure> made;
    record::for_damage_fields([&](const auto& field) {
      made.push_back({field.name, field.title, field.unit, field.shown.unit, field.shown.factor});
    });
    return made;
  }();
  return all;
}

std::optional<std::size_t> find_measure(std::string_view name) {
  for (std::size_t k = 0; k < measures().size(); ++k)
    if (measures()[k].name == name) return k;
  return std::nullopt;
}

std::optional<record::Damage> damage_between(const RunResult& run, std::string_view since,
                                             std::string_view stage) {
  if (!run.error.empty() || run.stages.empty()) return std::nullopt;
  const auto named = [&](std::string_view name) {
    return std::find_if(run.stages.begin(), run.stages.end(),
                        [&](const StageMeasures& s) { return s.name == name; });
  };
  const auto end = stage.empty() ? run.stages.end() - 1 : named(stage);
  if (end == run.stages.end()) return std::nullopt;
  record::Damage damage = end->damage;
  if (since.empty()) return damage;
  const auto start = named(since);
  if (start == run.stages.end()) return std::nullopt;
  for (const auto& field : record::damage_counts) damage.*field.number -= start->damage.*field.number;
  for (const auto& field : record::damage_fields)
    damage.*field.number = difference(damage.*field.number, start->damage.*field.number);
  // Of the stage and its end alone.
  damage.stage_displacement = end->damage.stage_displacement;
  damage.moving_area = end->damage.moving_area;
  // What fell between: the difference of two extremes would be of no block.
  std::vector<record::FallenBlock> fallen;
  for (const FallenBlock& f : run.fallen) {
    if (f.stage > start - run.stages.begin() && f.stage <= end - run.stages.begin())
      fallen.push_back({f.block, f.area, f.weight, f.depth, f.part});
  }
  record::set_extremes(fallen, damage);
  return damage;
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
