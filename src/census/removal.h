#pragma once
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "geometry/vec2.h"

/// What becomes of one rigid block between faces of rock that stays: kinematics and limit equilibrium of translations.
namespace keyblock::census {

/// A face that the block has in common with rock that stays.
struct HoldingFace {
  Vec2 out;                           ///< n, unit normal out of the block
  double length = 0.0;                ///< L, m, of the contact
  double edge_length = 0.0;           ///< m, of the whole edge
  double friction_coefficient = 0.0;  ///< tan φ
  double cohesion = 0.0;              ///< c, Pa
};

enum class Mode {
  falls,           ///< away from all faces, or along those without strength
  slides,          ///< along one face, or several in line
  slides_between,  ///< along faces on both sides
  stable,          ///< it could be taken out, but what acts on it does not do so
  not_removable,   ///< no translation leads out
};
constexpr std::size_t modes = 5;

/// "falls", "slides", "slides between faces", "stable", "not removable"
const char* mode_name(Mode mode);

/// Forces in N per metre thickness.
struct Removal {
  Mode mode = Mode::not_removable;
  Vec2 direction;                    ///< u, unit vector; of blocks that fall or slide
  double driving = 0.0;              ///< T
  double resisting = 0.0;            ///< Σ N tan φ + c L
  std::vector<std::size_t> sliding;  ///< faces along which it slides, ascending

  /// F = resisting / driving; infinite where nothing drives.
  [[nodiscard]] double factor() const {
    return driving > 0.0 ? resisting / driving : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] bool moves() const { return factor() < 1.0; }
  /// N per metre thickness, against u: with it, resisting forces divided by the wanted factor are enough.
  [[nodiscard]] double force_for(double wanted_factor) const;
};

/// Directions d that lead out of the faces are a cone (Goodman & Shi 1985, "Block theory and its application to rock engineering", in two
/// dimensions),
///
///     d·n_i ≤ 0   for all faces i,
///
/// which is empty (not removable), or has edges among ±t_i, t_i along the faces. Under the resultant R the block goes along the direction u
/// of the cone that makes the least angle with R; where that is 90° or more it is stable. u = R/|R| if that is in the cone. Limit
/// equilibrium along u:
///
///     T = R·u     N = |R − T u|     F = (Σ N_i tan φ_i + Σ c_i L_i) / T
///
/// with sums over the faces along u. N is shared by those of them that R presses on, by their lengths. Faces that open bear nothing.
///
/// `accuracy` (m): ends of edges are known to so much, and their directions to accuracy over edge length. A face does not hinder
/// directions that go into it by less, and edges of less than five times the accuracy bear nothing.
Removal find_removal(std::span<const HoldingFace> faces, Vec2 resultant, double accuracy);

}  // namespace keyblock::census
