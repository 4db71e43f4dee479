#pragma once
#include <optional>
#include <string_view>

namespace keyblock::loading {

/// The direction in which a component is positive.
struct MotionDirection {
  std::optional<double> azimuth;  ///< degrees from north, clockwise
  bool vertical = false;
  bool downwards = false;  ///< vertical and positive downwards

  [[nodiscard]] bool stated() const { return vertical || azimuth.has_value(); }
};

/// From words as files have them: "360", "90 DEG", "N21E", "N-S", "EW", "east", "up", "UD", "DWN", "164 (CDMG STATION 279)". Nothing
/// is set for any others. N-S is positive to the north, E-W to the east, U-D upwards.
MotionDirection parse_direction(std::string_view words);

/// From a channel code of seismometers such as HNE, HLN or BNZ, by its last letter.
MotionDirection channel_code_direction(std::string_view code);

}  // namespace keyblock::loading
