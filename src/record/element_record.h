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
  Vec2 from, to;                                                  ///< m, local
  double force = 0.0, elongation = 0.0, yielded = 0.0;            ///< N per thickness, m, m
  double moment = 0.0, shear = 0.0;                               ///< N m and N per thickness, of liners
  double utilization = std::numeric_limits<double>::quiet_NaN();  ///< not a number: it has no limit
  bool present = false;
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
     "force per metre of thickness; of springs tension is positive, of liners too; of all else it is the "
     "size "
     "of the resultant",
     &ElementState::force},
    {"elongation", "m",
     "since it was put in; of supports, boundaries and walls the mean way of what they hold; of "
     "liners the gap to the rock",
     &ElementState::elongation},
    {"yielded", "m", "of the elongation, that does not come back; of liners the slip along the rock",
     &ElementState::yielded},
    {"moment", "N",
     "moment per metre of thickness, of liners: positive where it stretches the side of the opening",
     &ElementState::moment},
    {"shear", "N/m", "shear force per metre of thickness, of liners", &ElementState::shear},
    {"utilization", "1",
     "force over the limit; of liners the largest stress over its strength; not a number without one",
     &ElementState::utilization}};
/// Files of earlier versions do not have those from here on.
inline constexpr std::size_t first_new_element_state = 3;
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
  double moment = 0.0, shear = 0.0;  ///< N m and N per thickness, of liners
  /// Of liners, the largest in the run, and what they carried then: N, N m and N per thickness. Infinite: it is none that has a strength.
  double worst_utilization = std::numeric_limits<double>::infinity();
  double worst_force = worst_utilization, worst_moment = worst_utilization, worst_shear = worst_utilization;

  [[nodiscard]] bool has_strength() const {
    return worst_utilization < std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] bool has_limit() const {
    return has_strength() || limit < std::numeric_limits<double>::infinity();
  }
  /// Largest force over the limit; 0 without one.
  [[nodiscard]] double utilization() const { return has_strength() ? worst_utilization : peak_force / limit; }
  [[nodiscard]] bool has_yielded() const {
    return has_strength() ? reaches_limit(worst_utilization, 1.0) : reaches_limit(peak_force, limit);
  }
};

/// The numbers of an element as files have them.
struct ElementField {
  const char* name;
  const char* unit;
  double ElementRecord::*number;
};
inline constexpr ElementField element_fields[] = {
    {"force_n_m", "N/m", &ElementRecord::force},
    {"elongation_m", "m", &ElementRecord::elongation},
    {"yielded_m", "m", &ElementRecord::yielded},
    {"peak_force_n_m", "N/m", &ElementRecord::peak_force},
    {"peak_time_s", "s", &ElementRecord::peak_time},
    {"limit_n_m", "N/m", &ElementRecord::limit},
    {"spacing_m", "m", &ElementRecord::spacing},
    {"force_n", "N", &ElementRecord::force_of_one},
    {"peak_force_n", "N", &ElementRecord::peak_force_of_one},
    {"moment_n", "N", &ElementRecord::moment},
    {"shear_n_m", "N/m", &ElementRecord::shear},
    {"worst_force_n_m", "N/m", &ElementRecord::worst_force},
    {"worst_moment_n", "N", &ElementRecord::worst_moment},
    {"worst_shear_n_m", "N/m", &ElementRecord::worst_shear},
    {"worst_utilization", "", &ElementRecord::worst_utilization}};
/// Files of earlier versions do not have those from here on.
inline constexpr std::size_t first_new_element_field = 9;

}  // namespace keyblock::record
