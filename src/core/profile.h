#pragma once
#include <array>
#include <chrono>
#include <cstddef>

namespace keyblock {

/// What a run spends its time on.
enum class Phase {
  other,
  detection,
  terms,
  assembly,
  factorization,
  solution,
  search,
  update,
  energy,
  output
};

struct PhaseName {
  const char* key;
  const char* meaning;
};
inline constexpr std::array<PhaseName, 10> phase_names{{
    {"other", "everything else: prediction, checks after a step, progress"},
    {"detection", "candidates of contact, and which of them are contacts"},
    {"terms", "geometry and springs of contacts; inertia, stress and stiffness of blocks"},
    {"assembly", "of the matrix"},
    {"factorization", "of the matrix, whole or in part"},
    {"solution", "with the factors"},
    {"search", "open-close iteration: states of contacts, line search, friction bounds"},
    {"update", "of positions, velocities and contact memory"},
    {"energy", "where the energy of the step went"},
    {"output", "frames, statistics, overlaps, checkpoints"},
}};
inline constexpr std::size_t phase_count = phase_names.size();

/// Wall time and number of entries by phase. At any moment one phase is being timed.
class Profile {
 public:
  struct Entry {
    double seconds = 0.0;
    long count = 0;
  };

  /// Times a phase until the end of the scope; the phase around it stands still meanwhile.
  class Scope {
   public:
    Scope(Profile& profile, Phase phase) : profile_(profile), outer_(profile.now_) {
      profile.enter(phase);
      ++profile.entries_[static_cast<std::size_t>(phase)].count;
    }
    ~Scope() { profile_.enter(outer_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Profile& profile_;
    Phase outer_;
  };

  [[nodiscard]] const Entry& operator[](Phase phase) const {
    return entries_[static_cast<std::size_t>(phase)];
  }

 private:
  using Clock = std::chrono::steady_clock;

  void enter(Phase phase) {
    const Clock::time_point now = Clock::now();
    entries_[static_cast<std::size_t>(now_)].seconds += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    now_ = phase;
  }

  std::array<Entry, phase_count> entries_{};
  Phase now_ = Phase::other;
  Clock::time_point since_ = Clock::now();
};

}  // namespace keyblock
