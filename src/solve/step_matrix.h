#pragma once
#include <span>
#include <vector>

#include "solve/step_system.h"

namespace keyblock::dynamics {

/// The matrix of a step, ∇²Π on certain branches of the laws of its rows, in the memory of a linear solver: which springs it has, and
/// how it comes to have those that act.
class StepMatrix {
 public:
  using Branch = SpringArray::Branch;

  /// At the start of a step; `is_known`: the solver has the matrix of an earlier step, which update() brings to this one.
  void begin_step(bool is_known) { is_assembled_ = is_known; }
  /// The next update() makes it anew.
  void forget() { is_assembled_ = false; }
  [[nodiscard]] bool is_assembled() const { return is_assembled_; }

  /// Makes it for the branches that the rows are on.
  void assemble(const StepSystem& system);
  /// Brings it to the branches that the rows are on now, and one of an earlier step to how its free blocks are turned. False when it
  /// has not changed.
  bool update(const StepSystem& system);

  /// Of a row, for which it was made.
  [[nodiscard]] Branch branch(std::size_t c) const { return branches_[c]; }
  /// N/m per thickness, of the spring of a row in it; 0: it has none.
  [[nodiscard]] double normal_stiffness(std::size_t c) const { return normal_stiffness_[c]; }
  [[nodiscard]] double shear_stiffness(std::size_t c) const { return shear_stiffness_[c]; }
  [[nodiscard]] bool has_spring(std::size_t c) const {
    return normal_stiffness_[c] != 0.0 || shear_stiffness_[c] != 0.0;
  }
  /// By how much the force of a row, of its own springs, differs from its straight line in the matrix.
  [[nodiscard]] SpringArray::Force force_beside(const SpringArray& springs, std::size_t c) const {
    return springs.force_at(c, springs.y[c], springs.w[c]) -
           springs.force_on(c, branches_[c], springs.y[c], springs.w[c]);
  }
  /// Whether the faces of joints press as the matrix has it, so that the straight lines of the matrix have their forces.
  [[nodiscard]] bool has_faces_as_they_press(const SpringArray& springs) const;
  /// N per thickness, per row, of the straight lines on which the matrix has the faces, at penetrations y; empty: there are none.
  [[nodiscard]] std::vector<double> face_lines(const SpringArray& springs, std::span<const double> y) const;
  /// Finds the rows that are on another branch than in the matrix.
  void find_differing(const StepSystem& system);
  /// As found last.
  [[nodiscard]] std::span<const std::size_t> differing() const { return differing_; }
  [[nodiscard]] std::size_t count_differing(const SpringArray& springs) const;
  /// Where the same springs act the matrix is the same: branches that differ in nothing else are taken for its own.
  void take_branches_with_the_same_springs(const StepSystem& system);
  /// What is known by row goes over to the rows of another step: now[k] of each of these, `gone` where it went. has_faces(): then,
  /// whether the faces are those of the step.
  void carry(std::span<const std::size_t> now, std::size_t gone, std::size_t rows);

  [[nodiscard]] bool has_faces(const FaceSprings& faces) const;

  /// Blocks that no spring of the matrix holds, nor any at `updated` rows. They may turn fast, which the factor of an earlier step knows
  /// nothing of, and are solved alone.
  void find_free_blocks(const StepSystem& system, std::span<const std::size_t> updated);
  [[nodiscard]] std::span<const std::size_t> free_blocks() const { return free_; }
  void forget_free_blocks() { free_.clear(); }
  /// The blocks of this row are free no more.
  void take_hold(const StepProblem& problem, const Row& row);

 private:
  void count_held(const StepSystem& system, std::size_t c, int count);
  void assemble_faces(const StepSystem& system);
  [[nodiscard]] bool update_faces(const StepSystem& system);
  void add_face(const StepSystem& system, std::size_t f, double scale) const;
  [[nodiscard]] std::span<double> tangent(std::size_t f) {
    return std::span(face_tangents_).subspan(first_tangents_[f], first_tangents_[f + 1] - first_tangents_[f]);
  }
  [[nodiscard]] std::span<const double> tangent(std::size_t f) const {
    return std::span(face_tangents_).subspan(first_tangents_[f], first_tangents_[f + 1] - first_tangents_[f]);
  }

  std::vector<Branch> branches_;                            ///< per row
  std::vector<double> normal_stiffness_, shear_stiffness_;  ///< N/m per thickness, per row
  std::vector<Place> places_;                               ///< of these springs
  std::vector<std::size_t> face_rows_, first_tangents_;     ///< as FaceSprings::all_rows; per face
  std::vector<Place> face_places_;                          ///< of these rows
  std::vector<double> face_tangents_;                       ///< N/m per thickness, H of each face by rows
  std::vector<int> held_;  ///< per unknown block: rows that have such springs
  std::vector<std::size_t> free_;
  std::vector<std::size_t> differing_;
  std::vector<SpringChange> changes_;  ///< scratch
  bool is_assembled_ = false;          ///< in this step
};

}  // namespace keyblock::dynamics
