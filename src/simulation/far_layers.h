#pragma once
#include <span>
#include <string>
#include <vector>

#include "simulation/rock_sample.h"

namespace keyblock::simulation {

/// The rock beside the model, taken from that at its sides.
struct FarLayers {
  std::vector<dynamics::RockLayer> left, right;  ///< from above; right is empty where both are alike
  std::string source;                            ///< "86 blocks and 38 m of joints in the outer 15 m"
  std::string gap;  ///< where there is no rock to take it from: "left side, -12 to -8 m"; empty: nowhere
  double contrast = 1.0;  ///< largest impedance of a side over that of the other at a height
};

/// Of strips beside both sides, a quarter of the model or six blocks wide, at most half of it, and bands of height: between heights where the
/// rock changes, and where the compliance of rock and joints does so by half. Bands alike within 3 % are one. Sides alike within 15 % have the
/// mean of both. setup.boundary must be there. pieces: the joints that count.
FarLayers far_layers(const RunSetup& setup, std::span<const JointPiece> pieces);

}  // namespace keyblock::simulation
