#pragma once
#include "record/record.h"

namespace keyblock::record {

/// A number that each contact has, described once: result.h5, exports and Python have their columns from here.
struct ContactField {
  const char* name;
  const char* unit;
  const char* meaning;
  double ContactRecord::*number;
  bool ContactParts::*part;  ///< what contacts are asked for, to have it
  /// The column has the size of the number alone. Results that have no other column of it are read by this one.
  bool is_magnitude = false;
  bool is_late =
      false;  ///< results of earlier versions do not have it: contacts have it as ContactRecord begins

  [[nodiscard]] double of(const ContactRecord& contact) const {
    return is_magnitude ? std::abs(contact.*number) : contact.*number;
  }
};

inline constexpr ContactField contact_fields[] = {
    {"length", "m", "of joint that belongs to the contact", &ContactRecord::length, &ContactParts::places},
    {"gap", "m", "as the law of the joint has it, negative where it is pressed", &ContactRecord::gap,
     &ContactParts::forces},
    {"slip", "m", "magnitude of shear_displacement", &ContactRecord::shear_displacement, &ContactParts::slips,
     true},
    {"shear_displacement", "m", "of block_a against block_b along (-normal_y, normal_x) since the excavation",
     &ContactRecord::shear_displacement, &ContactParts::slips},
    {"normal_force", "N/m", "per metre of thickness, compression positive", &ContactRecord::normal_force,
     &ContactParts::forces},
    {"shear_force", "N/m", "per metre of thickness; on block_a along (normal_y, -normal_x)",
     &ContactRecord::shear_force, &ContactParts::forces},
    {"water_pressure", "Pa", "of the water in the joint, beside which the forces are effective",
     &ContactRecord::water_pressure, &ContactParts::forces, false, true},
    {"strength_left", "1", "of what slip or opening takes from a joint; 0 of a bond that has broken",
     &ContactRecord::strength_left, &ContactParts::strengths, false, true}};

}  // namespace keyblock::record
