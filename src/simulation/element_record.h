#pragma once
#include <limits>
#include <string>

#include "geometry/vec2.h"

namespace keyblock::simulation {

/// An element at the end of a run.
struct ElementRecord {
  std::string name, kind;
  std::string peak_stage;  ///< name, of the largest force; empty: it has carried nothing
  bool present = false;
  Vec2 from, to;                           ///< m, local
  double force = 0.0;                      ///< N per thickness; of springs tension is positive
  double elongation = 0.0, yielded = 0.0;  ///< m
  double peak_force = 0.0;                 ///< N per thickness, its size
  double peak_time = 0.0;                  ///< s
  double limit = std::numeric_limits<double>::infinity();  ///< N per thickness; infinite: none

  /// Largest force over the limit; 0 without one.
  [[nodiscard]] double utilization() const { return peak_force / limit; }
  /// It has reached its limit; the force is that but for rounding then.
  [[nodiscard]] bool has_yielded() const { return peak_force >= (1.0 - 1e-9) * limit; }
};

/// The numbers of an element as files have them.
struct ElementField {
  const char* name;
  const char* unit;
  double ElementRecord::*number;
};
inline constexpr ElementField element_fields[] = {
    {"force_n_m", "N/m", &ElementRecord::force},     {"elongation_m", "m", &ElementRecord::elongation},
    {"yielded_m", "m", &ElementRecord::yielded},     {"peak_force_n_m", "N/m", &ElementRecord::peak_force},
    {"peak_time_s", "s", &ElementRecord::peak_time}, {"limit_n_m", "N/m", &ElementRecord::limit}};

}  // namespace keyblock::simulation
