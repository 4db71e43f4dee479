#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "record/record.h"

namespace keyblock::results {

/// The stretch of joint that a contact stands for, tied to the block it lies on so that it can be drawn at
/// any moment: from the point at `from` to the one at `to` (shares of the way) between display vertex
/// `vertex` and the next of its ring.
struct JointPiece {
  std::uint32_t vertex = 0;
  float from = 0.0F, to = 1.0F;
  float slip = 0.0F;  ///< m, without sign
  float gap = 0.0F;   ///< m
  record::ContactState state = record::ContactState::open;
  float lost = 0.0F;      ///< share of strength: 1 − ContactRecord::strength_left
  float pressure = 0.0F;  ///< Pa, of water
};

/// Finds where contacts lie. A straight edge of the reference configuration, which may consist of several
/// pieces between display vertices, is the *chain* that a contact's length is laid on: centred at the
/// contact, and shifted where it would reach over an end of the edge.
class JointLocator {
 public:
  explicit JointLocator(const record::ModelRecord& model);

  /// From where to where that stretch reaches, m, measured from the contact along perpendicular(normal): that is how
  /// the ring of block_b runs.
  [[nodiscard]] std::pair<double, double> reach(const record::ContactRecord& contact,
                                                std::span<const std::array<float, 2>> displacement) const;

  /// Appends the pieces of all contacts of one snapshot; `displacement` of all display vertices at that
  /// moment.
  void locate(std::span<const record::ContactRecord> contacts,
              std::span<const std::array<float, 2>> displacement, std::vector<JointPiece>& pieces) const;

 private:
  struct Chain {
    std::vector<std::uint32_t> vertices;  ///< first to last along the edge, one more than pieces
  };
  /// A point of a chain: how far along it, and along which piece.
  struct Foot {
    const Chain* chain = nullptr;
    std::size_t piece = 0;
    double share = 0.0;
  };
  /// The stretch of a contact: lengths along its chain, m.
  struct Stretch {
    const Chain* chain = nullptr;
    std::vector<double> arc;  ///< of the vertices of the chain
    double contact = 0.0, begin = 0.0, end = 0.0;
    double beyond = 0.0;  ///< how far past the end of the chain the contact itself is
  };
  using Displacement = std::span<const std::array<float, 2>>;

  [[nodiscard]] Vec2 position(std::uint32_t vertex, Displacement displacement) const;
  [[nodiscard]] Foot foot_of(const record::ContactRecord& contact, Displacement displacement) const;
  /// Where block_a lies along the edge, seen from the contact: +1 ahead in the direction of the unit vector `along`,
  /// −1 behind, 0 both or neither.
  [[nodiscard]] double side_of(const record::ContactRecord& contact, Vec2 along,
                               Displacement displacement) const;
  [[nodiscard]] Stretch stretch(const record::ContactRecord& contact, Displacement displacement) const;
  void add_ring(std::span<const std::uint32_t> ring, std::vector<Chain>& chains) const;
  const record::ModelRecord& model_;
  std::vector<std::vector<Chain>> chains_;  ///< by block
};

}  // namespace keyblock::results
