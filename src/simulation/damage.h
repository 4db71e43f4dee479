#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
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
  DamageGauge(const RunSetup& setup, const dynamics::Model& model) : setup_(setup), model_(model) {
    reference_.open.resize(setup.excavations.size());
  }

  /// Excavations, by index, that are about to be opened: their outlines count as openings from now on, and closure stays as it is
  /// where the rock of a wall is excavated.
  void open(std::span<const int> excavations, const dynamics::State& state);
  [[nodiscard]] bool started() const { return !reference_.start.empty(); }
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
  /// Two material points in the walls of the first excavation, where a line through its centroid leaves it.
  struct Diameter {
    Vec2 ends[2];              ///< reference positions
    int blocks[2] = {-1, -1};  ///< that hold them; −1: none does
    double length = 0.0;       ///< m, at the start
    double closure = 0.0;      ///< m, before the last excavation
  };
  struct Reference {
    std::vector<std::uint8_t> open;  ///< per excavation
    std::vector<Vec2> start;         ///< centroids, per block
    std::vector<JointPiece> pieces;  ///< ascending by vertex, then edge
    Diameter height, width;
  };
  [[nodiscard]] const Reference& reference() const { return reference_; }
  void restore(Reference reference);

 private:
  struct Offset {
    double slip, opening;
  };
  [[nodiscard]] Offset offset(const JointPiece& piece) const;
  void unite_openings();
  [[nodiscard]] double area_inside_openings(const Polygon& block) const;
  [[nodiscard]] Diameter diameter(const dynamics::State& state, Vec2 direction) const;
  /// Distance of the ends of a diameter now; nothing where one of them is in no block.
  [[nodiscard]] std::optional<double> length(const Diameter& d, const dynamics::State& state) const;
  [[nodiscard]] double closure(const Diameter& d, const dynamics::State& state) const;

  const RunSetup& setup_;
  const dynamics::Model& model_;
  Reference reference_;
  std::vector<Polygon> openings_;  ///< what the outlines of open excavations cover together
};

}  // namespace keyblock::simulation
