#include "synthetic_damage.h"

#include <cmath>

#include "record/fallen.h"

namespace keyblock::made_up {

record::Damage synthetic_damage(std::size_t stage, const std::vector<record::FallenBlock>& fallen,
                                double loosened, Vec2 opening) {
  record::Damage damage;
  if (stage >= 1) {
    damage.slip_max = damage.slip_max_ever = 4.0e-4;
    damage.slip_mean = 2.1e-5;
    damage.closure_vertical = 1.2e-3;
    damage.closure_horizontal = 6.0e-4;
  }
  if (stage < 2) return damage;
  damage.loosened_area = loosened;
  for (const record::FallenBlock& block : fallen) {
    ++damage.fallen_blocks;
    damage.fallen_area += block.area;
    damage.fallen_weight += block.weight;
  }
  record::set_extremes(fallen, damage);
  damage.largest_block_pressure = damage.largest_fallen_weight / std::sqrt(damage.largest_fallen_area);
  damage.displacement_max = 1.9;
  damage.rotation_max = 38.0;
  damage.hinges = 11;
  damage.opening_filled_ratio = damage.fallen_area / (opening.x * opening.y);
  // Blocks fell, and the crown with them.
  damage.slip_max = 0.0196;
  damage.slip_max_ever = 0.0731;
  damage.slip_mean = 0.0021;
  damage.slipped_length = 27.3;
  damage.slipped_length_ever = 31.7;
  damage.opening_max = 0.0052;
  damage.opening_max_ever = 0.0384;
  damage.opened_length = 6.1;
  damage.opened_length_ever = 9.4 + 0.6 * static_cast<double>(stage);
  damage.closure_vertical = std::nan("");
  damage.closure_horizontal = -2.1e-3;
  return damage;
}

std::vector<std::pair<std::string, std::string>> synthetic_ground() {
  return {{"opening “tunnel”", "polygon, 8 m wide, 5.4 m high"},
          {"depth", "80 m of rock above the model"},
          {"K₀", "0.8"},
          {"unit weight γ", "22.27 kN/m³ (2270 kg/m³)"},
          {"Young's modulus E", "12 GPa"},
          {"joints: friction φ", "35°"},
          {"joints: stiffness", "kn 240 GPa/m, ks 96 GPa/m (default)"},
          {"set “bed joints”",
           "dip 0° towards 90° (0° down to the right in the section), spacing 0.6 m, length 8 ± 2 m"},
          {"motion “quake”", "record_090.smc, record_up.smc"}};
}

}  // namespace keyblock::made_up
