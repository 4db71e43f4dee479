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

const std::array<Intensity, intensity_count> all_intensities{
    {{"pga_m_s2", "PGA", "m/s²", &StageMeasures::pga, 1, "PGA", "section"},
     {"pgv_m_s", "PGV", "m/s", &StageMeasures::pgv, 1, "PGV", "section"},
     {"arias_m_s", "Arias intensity", "m/s", &StageMeasures::arias, 2, "IA", "section"},
     {"pga_rotd50_m_s2", "PGA (RotD50)", "m/s²", &StageMeasures::pga_rotd50, 1, "PGA", "rotd50"},
     {"pgv_rotd50_m_s", "PGV (RotD50)", "m/s", &StageMeasures::pgv_rotd50, 1, "PGV", "rotd50"},
     {"sa_03_rotd50_m_s2", "SA(0.3 s) (RotD50)", "m/s²", &StageMeasures::sa_03_rotd50, 1, "SA(0.3)",
      "rotd50"},
     {"sa_10_rotd50_m_s2", "SA(1 s) (RotD50)", "m/s²", &StageMeasures::sa_10_rotd50, 1, "SA(1.0)",
      "rotd50"}}};

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

namespace {

/// Places in RunResult::stages: measures begin at the end of `first` (−1: at the first excavation) and end at that of `last`.
struct Stretch {
  std::ptrdiff_t first = -1, last = -1;
};

std::optional<Stretch> stretch_of(const RunResult& run, std::string_view since, std::string_view stage) {
  if (!run.error.empty() || run.stages.empty()) return std::nullopt;
  const auto count = static_cast<std::ptrdiff_t>(run.stages.size());
  const auto named = [&](std::string_view name) {
    return std::ranges::find(run.stages, name, &StageMeasures::name) - run.stages.begin();
  };
  const Stretch stretch{since.empty() ? -1 : named(since), stage.empty() ? count - 1 : named(stage)};
  return stretch.first == count || stretch.last == count ? std::nullopt : std::optional(stretch);
}

std::vector<record::FallenBlock> fallen_in(const RunResult& run, Stretch stretch) {
  std::vector<record::FallenBlock> fallen;
  for (const FallenBlock& f : run.fallen)
    if (f.stage > stretch.first && f.stage <= stretch.last)
      fallen.push_back({f.block, f.area, f.weight, f.depth, f.part});
  return fallen;
}

void take_off(record::Damage& damage, const record::Damage& other) {
  for (const auto& field : record::damage_counts) damage.*field.number -= other.*field.number;
  for (const auto& field : record::damage_fields)
    damage.*field.number = difference(damage.*field.number, other.*field.number);
}

}  // namespace

std::optional<record::Damage> damage_between(const RunResult& run, std::string_view since,
                                             std::string_view stage) {
  const auto stretch = stretch_of(run, since, stage);
  if (!stretch) return std::nullopt;
  const record::Damage& end = run.stages[static_cast<std::size_t>(stretch->last)].damage;
  record::Damage damage = end;
  if (stretch->first < 0) return damage;
  take_off(damage, run.stages[static_cast<std::size_t>(stretch->first)].damage);
  // Of the stage and its end alone.
  damage.stage_displacement = end.stage_displacement;
  damage.moving_area = end.moving_area;
  // What fell between: the difference of two extremes would be of no block.
  record::set_extremes(fallen_in(run, *stretch), damage);
  return damage;
}

std::optional<record::Damage> damage_beyond(const RunResult& run, const RunResult& control,
                                            std::string_view since, std::string_view stage) {
  auto damage = damage_between(run, since, stage);
  const auto unshaken = damage_between(control, since, stage);
  if (!damage || !unshaken) return std::nullopt;
  const record::Damage own = *damage;
  take_off(*damage, *unshaken);
  damage->stage_displacement = own.stage_displacement;
  damage->moving_area = own.moving_area;
  std::vector<record::FallenBlock> fallen = fallen_in(run, *stretch_of(run, since, stage));
  const std::vector<record::FallenBlock> anyway = fallen_in(control, *stretch_of(control, since, stage));
  std::erase_if(fallen, [&](const record::FallenBlock& f) {
    return std::ranges::find(anyway, f.block, &record::FallenBlock::block) != anyway.end();
  });
  record::set_extremes(fallen, *damage);
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
