#pragma once
#include <array>
#include <span>
#include <vector>

#include "solve/corrections.h"
#include "solve/iterate.h"
#include "solve/step_matrix.h"

namespace keyblock::dynamics {

/// Accelerator: goes to the minimum with the factor at hand, while springs that act otherwise than the matrix has them are taken into account
/// by a low-rank update (Corrections). A few of thousands are in most steps, and a solution takes a tenth of a factorization.
///
/// What the factor gets wrong, of an earlier step or of single precision, shows in the exact gradient and is refined away.
class LowRankUpdate {
 public:
  /// Goes to the minimum: from D, where springs and gradient are, or from zero, where the gradient need not be. is_kept: the factor is of an
  /// earlier step. Springs that act otherwise become more until no other does, so that this ends. False when they are too many, when their
  /// forces are not found, and when what the factor gets wrong is not refined away. Springs and gradient are those of D in any case.
  bool minimize(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, bool is_kept, bool from_zero,
                OpenCloseResult& result);
  /// Forgets the springs that are updated: the factor is another.
  void reset() {
    corrections_.clear();
    updated_.clear();
    place_.clear();
  }
  /// Springs that it updates, at most.
  [[nodiscard]] static std::size_t limit(const StepSystem& system);
  /// Springs that are updated.
  [[nodiscard]] std::size_t size() const { return corrections_.size(); }
  /// Their rows.
  [[nodiscard]] std::vector<std::size_t> rows() const;
  /// Goes over to the rows of another step, as StepMatrix::carry(); none is gone.
  void carry(std::span<const std::size_t> now);

 private:
  /// The normal or the shear spring of a row.
  struct Spring {
    std::size_t row;
    bool normal;
    [[nodiscard]] std::size_t number() const { return 2 * row + (normal ? 0 : 1); }
  };
  bool refines(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, bool wants);
  bool iterate_until_done(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, bool is_kept,
                          bool from_zero, OpenCloseResult& result);
  bool begin(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, bool is_kept, double enough,
             bool from_zero, std::span<double> direction);
  void start_on_lines(const StepSystem& system, Iterate& iterate, const StepMatrix& matrix);
  void go(const StepSystem& system, Iterate& iterate, StepMatrix& matrix, std::span<const double> direction,
          OpenCloseResult& result);
  bool solve(const StepSystem& system, const StepMatrix& matrix, std::size_t fresh,
             std::span<double> direction);
  static double find_law(const SpringArray& springs, const StepMatrix& matrix, Spring spring,
                         Corrections::Law& law);
  bool find_forces(const StepSystem& system, const StepMatrix& matrix, std::size_t fresh);
  [[nodiscard]] bool is_exact(const StepSystem& system, bool is_kept) const;
  void look_at_faces(const StepSystem& system, const StepMatrix& matrix);
  void remember_places();
  [[nodiscard]] bool is_updated(Spring spring) const {
    return spring.number() < place_.size() && place_[spring.number()] > 0;
  }
  void find_wanted(const SpringArray& springs, const StepMatrix& matrix);
  void take_wanted(const StepSystem& system, StepMatrix& matrix);
  void leave_out_wanted(const StepSystem& system, Iterate& iterate, const StepMatrix& matrix);
  void find_rest(const StepSystem& system, Iterate& iterate, const StepMatrix& matrix);

  Corrections corrections_;  ///< of the springs in updated_
  std::vector<Spring> updated_;
  std::vector<std::size_t>
      place_;                   ///< by Spring::number(): 1 + where it is in updated_; 0, or beyond: nowhere
  std::vector<Spring> wanted_;  ///< act otherwise than the matrix has them, and are not updated yet
  std::vector<double> force_;   ///< N per thickness, per updated spring: what it does otherwise than its line
  std::vector<double> base_;    ///< L⁻¹ of the right hand side with which no spring is updated
  // Scratch.
  std::vector<Corrections::Law> laws_;
  std::vector<double> stretch_;
  std::vector<std::array<std::vector<double>, 2>> parts_;  ///< of the two blocks of a spring
  std::vector<linalg::LowRankSolver::PairVector> vectors_;
  bool faces_bend_ = false;  ///< since begin(): faces of joints press otherwise than the matrix has it
};

}  // namespace keyblock::dynamics
