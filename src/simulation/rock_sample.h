#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "coupling/rock_column.h"
#include "geometry/vec2.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// A stretch of joint between two blocks as cut, before anything is excavated.
struct JointPiece {
  std::size_t a = 0, b = 0;  ///< blocks
  Vec2 from, to;
  cutting::EdgeLabel label;
};

/// All of them, in the order of their left ends. Edges face each other where they are less than a thousandth of the block size apart.
/// Outlines of openings are none: the rock there is still one.
std::vector<JointPiece> joint_pieces(const RunSetup& setup);

/// Of the joint that an edge is a piece of.
const contact::JointProperties& joint_of(const JointTable& joints, cutting::EdgeLabel label);

/// m, √ of the mean area of the blocks.
double mean_block_size(const RunSetup& setup);

/// Rock in a part of the model, as long waves that go up and down feel it: with the areas A_b of blocks in it and the lengths L_i of joints,
/// their normals n and stiffnesses, and stress and strain in the order xx, yy, xy, with the engineering shear strain,
///
///     ρ = Σ ρ_b A_b / A,    S = Σ A_b S_b / A + Σ L_i / A (N Nᵀ/k_n + T Tᵀ/k_s),
///     A = Σ A_b,            N = (n_x², n_y², 2 n_x n_y),   T = (−n_x n_y, n_x n_y, n_x² − n_y²)
///
/// S_b: compliance of the rock in the section. Moduli are those of S⁻¹, where nothing moves sideways. A joint on the border of the part
/// counts half.
class RockSample {
 public:
  /// Of what moves; fixed blocks are no rock. pieces: the joints that count.
  RockSample(const RunSetup& setup, std::span<const JointPiece> pieces, const Box& part);

  RockSample& operator+=(const RockSample& other);
  /// None without rock.
  [[nodiscard]] std::optional<dynamics::RockLayer> layer(double top) const;
  /// 1/Pa, strain of shear under a shear stress of 1.
  [[nodiscard]] double shear_compliance() const { return area_ > 0.0 ? compliance_[2][2] / area_ : 0.0; }
  /// Share of the part that blocks fill, fixed ones as well.
  [[nodiscard]] double filled() const { return filled_ / whole_; }
  [[nodiscard]] int blocks() const { return blocks_; }
  [[nodiscard]] double joint_length() const { return joint_length_; }  ///< m

 private:
  /// Symmetric, in the order xx, yy, xy; less what it is a mean over.
  using Matrix = std::array<std::array<double, 3>, 3>;
  void add_block(const block::Material& rock, double area);
  void add_joint(Vec2 along, double length, double normal, double shear);

  double whole_ = 0.0, filled_ = 0.0, area_ = 0.0;  ///< m²
  double mass_ = 0.0;                               ///< kg per thickness
  double joint_length_ = 0.0;                       ///< m
  int blocks_ = 0;
  Matrix compliance_{};
};

}  // namespace keyblock::simulation
