#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contact/detection.h"
#include "dynamics/model.h"
#include "dynamics/state.h"
#include "simulation/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Position of block b's outline now: the polygon of its contact vertices.
Polygon deformed_polygon(const dynamics::Model& model, std::size_t block);

/// Measures what has happened since the first excavation, as the user guide defines it.
///
/// Joints are followed by material points: at the excavation every contact in place becomes a piece of joint, of a
/// length, between a point on either side. Slip is the displacement of the one point against the other along the joint as
/// it lies now, opening that across it. Pieces beside a fallen block no longer count; those along the frame never do.
class DamageGauge {
 public:
  DamageGauge(const RunSetup& setup, const dynamics::Model& model)
      : setup_(setup), model_(model), open_(setup.excavations.size()) {}

  /// The outlines of these excavations, by index, count as openings from now on.
  void open(std::span<const int> excavations);
  [[nodiscard]] bool started() const { return !start_.empty(); }
  /// Takes the present state as the reference. Blocks of the excavations are gone by now.
  void start(const dynamics::State& state, std::span<const contact::Contact> contacts);

  [[nodiscard]] std::vector<BlockStatus> status(const dynamics::State& state) const;
  [[nodiscard]] Damage measure(const dynamics::State& state) const;
  /// Slip of the piece of joint at a contact, by its vertex and edge; 0 for contacts made later.
  [[nodiscard]] double slip(int vertex, int edge) const;
  [[nodiscard]] std::optional<double> opening_width() const;

  struct JointPiece {
    int vertex = 0, edge = 0;
    double along = 0.0;   ///< of the point on the edge, 0 … 1
    double length = 0.0;  ///< m
  };
  struct Reference {
    std::vector<Vec2> start;  ///< centroids, per block
    std::vector<JointPiece> pieces;
    double height = 0.0, width = 0.0;  ///< m, diameters of the opening
  };
  [[nodiscard]] Reference reference() const { return {start_, pieces_, height_, width_}; }
  void restore(Reference reference);

 private:
  struct Offset {
    double slip, opening;
  };
  [[nodiscard]] Offset offset(const JointPiece& piece) const;
  /// f(outline) of every opening.
  template <typename Function>
  void for_each_opening(const Function& f) const;
  [[nodiscard]] double area_inside_openings(const Polygon& block) const;
  /// Distance between two material points, those where the walls stand at the ends of a diameter of the first opening;
  /// 0 where no block does.
  [[nodiscard]] double diameter(const dynamics::State& state, Vec2 direction) const;

  const RunSetup& setup_;
  const dynamics::Model& model_;
  std::vector<std::uint8_t> open_;  ///< per excavation
  std::vector<Vec2> start_;
  std::vector<JointPiece> pieces_;  ///< ascending by vertex, then edge
  double height_ = 0.0, width_ = 0.0;
};

}  // namespace keyblock::simulation
