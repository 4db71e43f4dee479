#pragma once
#include <limits>
#include <span>
#include <string>

#include "geometry/vec2.h"

namespace keyblock::record {

/// Whether an element of a limit has reached it; the force is that but for rounding then.
inline bool reaches_limit(double force, double limit) {
  return force >= (1.0 - 1e-9) * limit;
}

/// An element of a model (dynamics::Element).
struct ElementDescription {
  std::string name, kind;
  double limit = std::numeric_limits<double>::infinity();  ///< N per thickness; infinite: none
  Vec2 from, to;                                           ///< m, local, before the run
  int from_block = -1, to_block = -1;                      ///< −1: of several
  double spacing =
      std::numeric_limits<double>::infinity();  ///< m out of plane; infinite: it goes on through the section

  friend bool operator==(const ElementDescription&, const ElementDescription&) = default;
};

/// A history of what an element carries.
struct ElementHistory {
  std::string name;
  int element = 0;

  friend bool operator==(const ElementHistory&, const ElementHistory&) = default;
};

/// What an element carries at a moment (dynamics::Carried).
struct ElementState {
  Vec2 from, to;                                        ///< m, local
  double force = 0.0, elongation = 0.0, yielded = 0.0;  ///< N per thickness, m, m
  bool present = false;

  /// Force over the limit of its element; 0 without one.
  [[nodiscard]] double utilization(const ElementDescription& of) const {
    return (force < 0.0 ? -force : force) / of.limit;
  }
};

/// The numbers of an element at a moment, as files have them.
struct ElementStateField {
  const char* name;
  const char* unit;
  const char* meaning;
  double ElementState::*number;
};
inline constexpr ElementStateField element_state_fields[] = {
    {"force", "N/m",
     "force per metre of thickness; of springs tension is positive, of all else it is the size of the "
     "resultant",
     &ElementState::force},
    {"elongation", "m",
     "since it was put in; of supports, boundaries and walls the mean way of what they hold",
     &ElementState::elongation},
    {"yielded", "m", "of the elongation, that does not come back", &ElementState::yielded}};
/// Those that histories have.
inline constexpr std::span element_history_fields = std::span(element_state_fields).first<2>();

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
  /// m out of plane, of which a section has one, and N, of one: the force, and the largest in the run. Infinite: it goes on through the section.
  double spacing = std::numeric_limits<double>::infinity();
  double force_of_one = spacing, peak_force_of_one = spacing;
  bool ruptured = false;

  /// Largest force over the limit; 0 without one.
  [[nodiscard]] double utilization() const { return peak_force / limit; }
  [[nodiscard]] bool has_yielded() const { return reaches_limit(peak_force, limit); }
};

/// The numbers of an element as files have them.
struct ElementField {
  const char* name;
  const char* unit;
  double ElementRecord::*number;
};
inline constexpr ElementField element_fields[] = {{"force_n_m", "N/m", &ElementRecord::force},
                                                  {"elongation_m", "m", &ElementRecord::elongation},
                                                  {"yielded_m", "m", &ElementRecord::yielded},
                                                  {"peak_force_n_m", "N/m", &ElementRecord::peak_force},
                                                  {"peak_time_s", "s", &ElementRecord::peak_time},
                                                  {"limit_n_m", "N/m", &ElementRecord::limit},
                                                  {"spacing_m", "m", &ElementRecord::spacing},
                                                  {"force_n", "N", &ElementRecord::force_of_one},
                                                  {"peak_force_n", "N", &ElementRecord::peak_force_of_one}};

}  // namespace keyblock::record
