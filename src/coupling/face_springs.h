#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "contact/joint_pressure.h"
#include "core/lanes.h"

namespace keyblock::dynamics {

/// The normal springs that rows share: pressures of faces of joints (contact::JointPressure). They press with F_i(y) on their rows, y being the
/// penetrations of all rows of the face, beside what the own springs of the rows do.
///
/// A matrix has a tangent H of each. F is homogeneous, so that the straight line which goes on from a state is H y.
class FaceSprings {
 public:
  void begin(std::size_t rows);
  /// dashpot: of the pressure, over its stiffness without it.
  void add(const contact::JointPressure& pressure, double dashpot, std::span<const std::size_t> rows);

  [[nodiscard]] bool empty() const { return faces_.empty(); }
  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  [[nodiscard]] const contact::JointPressure& pressure(std::size_t f) const { return faces_[f].pressure; }
  /// What of the pressure is elastic.
  [[nodiscard]] contact::JointPressure elastic_pressure(std::size_t f) const {
    return faces_[f].pressure.stiffer(1.0 / (1.0 + faces_[f].dashpot));
  }
  /// Of the normal springs of a row of faces: what is elastic of their stiffness.
  [[nodiscard]] double elastic_share(std::size_t row) const { return elastic_share_[row]; }
  [[nodiscard]] std::span<const std::size_t> rows_of(std::size_t f) const {
    return std::span(rows_).subspan(faces_[f].first, faces_[f].pressure.size());
  }
  /// Of all faces, one after the other.
  [[nodiscard]] std::span<const std::size_t> all_rows() const { return rows_; }
  [[nodiscard]] bool has(std::size_t row) const { return !empty() && stiffness_[row] > 0.0; }

  /// N per thickness, that faces press a row with, as press() found it last.
  [[nodiscard]] double force(std::size_t row) const { return empty() ? 0.0 : force_[row]; }
  [[nodiscard]] Lanes forces(std::size_t row) const { return empty() ? Lanes{} : load(&force_[row]); }
  /// N per thickness, likewise: what of the pressure the row bears for friction (contact::JointPressure).
  [[nodiscard]] double bearing(std::size_t row) const { return empty() ? 0.0 : bearing_[row]; }
  [[nodiscard]] Lanes bearings(std::size_t row) const { return empty() ? Lanes{} : load(&bearing_[row]); }
  /// N/m per thickness, of a row that alone is pressed in, its faces closed all along.
  [[nodiscard]] double stiffness(std::size_t row) const { return empty() ? 0.0 : stiffness_[row]; }

  /// Forces at penetrations y, m, per row.
  void press(std::span<const double> y);
  /// A bond of the row has broken: its faces pull no more. press() follows.
  void pull_no_more(std::size_t row);

  /// Calls of_face(f) for the faces of some rows, each once: those whose first row is among them.
  template <typename OfFace>
  void for_faces_of(std::span<const std::size_t> rows, const OfFace& of_face) const {
    for (const std::size_t row : rows) {
      for (int k = first_of_row_[row]; k >= 0; k = next_of_row_[static_cast<std::size_t>(k)])
        of_face(static_cast<std::size_t>(k));
    }
  }

  /// F_i of a face at y + α dy, per point of it. N per thickness.
  void forces_at(std::size_t f, std::span<const double> y, std::span<const double> dy, double alpha,
                 std::span<double> force) const;
  /// H_ij of a face at y, N/m per thickness.
  void tangent(std::size_t f, std::span<const double> y, std::span<double> h) const;
  /// Whether the forces of a face are linear from y to y + α dy.
  [[nodiscard]] bool is_linear(std::size_t f, std::span<const double> y, std::span<const double> dy,
                               double alpha) const;

 private:
  struct Face {
    std::size_t first;  ///< of its rows
    contact::JointPressure pressure;
    double dashpot;  ///< over stiffness
  };
  std::vector<Face> faces_;
  std::vector<std::size_t> rows_;
  std::vector<int> first_of_row_, next_of_row_;  ///< per row, per face: faces by their first row; −1: none
  std::vector<double> force_, bearing_, stiffness_;  ///< per row
  std::vector<double> elastic_share_;                ///< per row of a face
};

/// What the pressure of a face does otherwise than a straight line on which it was at the start of a way y + α dy.
class FaceBend {
 public:
  explicit FaceBend(std::size_t face) : face_(face) {}
  [[nodiscard]] std::size_t face() const { return face_; }
  /// Σ (F_i(y + α dy) − F_i(y) − α (H dy)_i) dy_i.
  [[nodiscard]] double slope(const FaceSprings& faces, std::span<const double> y, std::span<const double> dy,
                             double alpha) const;
  /// Calls of_row(row, F_i(y + α dy) − F_i(y) − α (H dy)_i).
  template <typename OfRow>
  void for_rows(const FaceSprings& faces, std::span<const double> y, std::span<const double> dy, double alpha,
                const OfRow& of_row) const {
    Forces beside{};
    find(faces, y, dy, alpha, beside);
    const std::span<const std::size_t> rows = faces.rows_of(face_);
    for (std::size_t i = 0; i < rows.size(); ++i) of_row(rows[i], beside[i]);
  }

 private:
  using Forces = std::array<double, contact::JointPressure::most_points>;
  void find(const FaceSprings& faces, std::span<const double> y, std::span<const double> dy, double alpha,
            Forces& beside) const;
  std::size_t face_;
};

}  // namespace keyblock::dynamics
