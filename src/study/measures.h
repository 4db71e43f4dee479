#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "study/run_result.h"

namespace keyblock::study {

/// A measure of damage, as summary.json has it.
struct Measure {
  std::string name;           ///< "fallen_area_m2"
  std::string title;          ///< "fallen area"
  std::string unit;           ///< "m²"; empty for counts and ratios
  std::string shown_unit;     ///< in which pages show it: of a weight, "kN/m" per metre of tunnel
  double shown_factor = 1.0;  ///< numbers times this are in that unit
  [[nodiscard]] double of(const record::Damage& damage) const;
};

/// All measures, in the order of summary.json.
std::span<const Measure> measures();

/// Place of a measure in measures() by its name; none when there is no such measure.
std::optional<std::size_t> find_measure(std::string_view name);

/// What happened to a run until the end of `stage` (empty: its last), less what had happened by the end of `since` (empty:
/// nothing). Differences are rounded to 1e-9 m², m or shares. The largest fallen block and the depths of fallen rock are those of the blocks
/// that fell between. None when the run failed or did not get there.
std::optional<record::Damage> damage_between(const RunResult& run, std::string_view since,
                                             std::string_view stage);

/// The same, less what happened in the control run: what the shaking did. Measures may be negative, where rock that gravity would have
/// brought down stayed. The largest fallen block and the depths are those of the blocks that fell in this run alone.
std::optional<record::Damage> damage_beyond(const RunResult& run, const RunResult& control,
                                            std::string_view since, std::string_view stage);

inline constexpr std::size_t intensity_count = 7;

/// Kinds of intensity of shaking.
struct Intensity {
  std::string name;   ///< "pga_m_s2"
  std::string title;  ///< "PGA"
  std::string unit;   ///< "m/s²"
  double StageMeasures::*of;
  int power;              ///< it goes with this power of the amplitude of a motion
  std::string kind;       ///< as hazard curves name it: "PGA"
  std::string component;  ///< of what shaking: "section", the vector in the section, up included
};
std::span<const Intensity> intensities();

/// The value on an axis for people and tables: a TOML string without escapes loses its quotes, all else stays.
std::string plain_value(std::string_view toml);

}  // namespace keyblock::study
