#pragma once
#include <span>
#include <vector>

#include "contact/detection.h"
#include "contact/vertex_edge_list.h"
#include "model/model.h"
#include "record/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Slip and opening of joints, followed by material points: at the reference every contact in place becomes a piece of joint, of a
/// length, between a point on either side. Slip is the displacement of the one point against the other along the joint as
/// it lies now, opening that across it. Pieces along the frame never count.
///
/// A piece is *in place* while both of its blocks are there and have not fallen. What pieces *ever* had is remembered: the largest
/// slip and opening of each at all looks (`watch`) that saw it in place. A block that falls takes nothing away from that.
class JointGauge {
 public:
  JointGauge(const RunSetup& setup, const dynamics::Model& model) : setup_(setup), model_(model) {}

  struct Piece {
    int vertex = 0, edge = 0;
    double along = 0.0;                          ///< of the point on the edge, 0 … 1
    double length = 0.0;                         ///< m
    double slip_ever = 0.0, opening_ever = 0.0;  ///< m, largest at all looks
  };
  /// Takes the contacts in place as the pieces.
  void start(std::span<const contact::Contact> contacts);
  /// Looks at all pieces. `status`: of every block now.
  void watch(std::span<const record::BlockStatus> status);
  /// Adds slip, opening and hinges to `damage`: in place now, and ever up to the last look.
  void measure(std::span<const record::BlockStatus> status, record::Damage& damage) const;
  /// m. Slip of the piece at each contact, by its vertex and edge; 0 for contacts made later.
  void slips(std::span<const contact::Contact> contacts, std::span<double> slips) const;

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_.all(); }
  /// Takes pieces that ascend by vertex, then edge.
  void restore(std::vector<Piece> pieces);

 private:
  struct Offset {
    double slip, opening;
  };
  /// Pairs of blocks with a piece of joint in place that is open beyond the limit, and one that is not.
  [[nodiscard]] int hinges(std::span<const record::BlockStatus> status) const;
  [[nodiscard]] Offset offset(const Piece& piece) const;
  [[nodiscard]] bool in_place(const Piece& piece, std::span<const record::BlockStatus> status) const;

  const RunSetup& setup_;
  const dynamics::Model& model_;
  contact::VertexEdgeList<Piece> pieces_;
};

}  // namespace keyblock::simulation
