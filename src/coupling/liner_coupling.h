#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "loading/liner.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// How far the wall behind each station of liners has gone since before the run.
struct LinerWay {
  std::vector<double> known;  ///< m of wall that it is known of; 0: there is no rock
  std::vector<Vec2> moved, velocity;
};

/// A cross-section of a liner: two nodes of a line body, the outer one `outer` and the inner one after it, t/√3 from the centre line. They are where a beam
/// has the chords of its truss, and not its faces.
struct LinerStation {
  std::string name;
  std::size_t liner = 0;
  int body = 0;
  int outer = 0;                ///< node of the body
  double length = 0.0;          ///< m, of wall
  double area = 0.0;            ///< m², of each node
  Vec2 wall, out;               ///< m, place on the wall and direction into the rock before the run
  int before = -1, after = -1;  ///< stations beside it, by number; −1: the liner ends
};

/// The bond of a station to a block.
struct LinerLink {
  std::size_t station = 0;
  double length = 0.0;  ///< m, of wall that the block has of the station's
  MaterialPoint rock;   ///< where the station is
};

/// A beam between two stations.
struct LinerBeam {
  std::size_t from = 0, to = 0;
  double length = 0.0;  ///< m, along the centre line
};

/// Liners of shotcrete: elastic Euler beams on an interface to rock. A beam of length h, with EI and EA, is a truss of two chords at ±c, c = t/√3, and two
/// diagonals of length ℓ between its ends,
///
///     k_chord = EI/(2 c² h)      k_diagonal = (3/2) EI ℓ²/(c² h³)      ℓ² = h² + 4 c²
///
/// which for c² = t²/3 = 4 EI/EA has the stiffness of that beam exactly: axial 2 k_chord + 2 k_diagonal h²/ℓ² = EA/h, bending 2 k_chord c² = EI/h, and
/// shear 2 k_diagonal (2c/ℓ)² = 12 EI/h³. Bars have the lengths of the positions at the start of the step, so that a liner may turn by any angle. A strut
/// between the two nodes of a station, a term of its body, keeps them apart.
///
/// Interface: at each station a row to each block that it lies on, with the lengths of wall as shares. Bonded, both springs hold; beyond the adhesion, or cohesion
/// and friction, the bond breaks for good, an event. Then the normal spring presses alone, and the shear spring slips by friction.
class LinerCoupling final : public Coupling, public StagedSupports {
 public:
  LinerCoupling(std::vector<loading::Liner> liners, std::vector<LinerStation> stations,
                std::vector<LinerBeam> beams, std::vector<LinerLink> links, const Model& model);

  [[nodiscard]] std::span<const MaterialPoint> points() const override { return points_; }
  void add_pairs(BlockPairs& pairs) const override;
  [[nodiscard]] std::size_t memory_size() const override { return bars() + link_numbers * links_.size(); }
  void add_terms(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 BlockTerms& terms) const override;
  [[nodiscard]] std::size_t rows() const override { return bars() + links_.size(); }
  RowFacts build(const Model& model, const State& state, const Drive& drive, std::span<const double> memory,
                 CouplingRows out) const override;
  void change_laws(const StepProblem& problem, std::size_t first, std::span<const double> memory,
                   std::vector<LawChange>& changes) const override;
  [[nodiscard]] const StagedSupports* staged_supports() const override { return this; }
  void place(const Model& model, State& state) const override;
  void install(const Model& model, State& state, std::span<const std::uint8_t> now,
               std::span<double> memory) const override;
  CouplingTotals account(const Attempt& attempt, std::span<const double> spin, std::size_t first,
                         std::span<double> memory, State& state) const override;
  [[nodiscard]] double stored_energy(const Model& model, const State& state, double time,
                                     std::span<const double> memory) const override;
  [[nodiscard]] std::vector<Element> elements() const override;
  [[nodiscard]] std::vector<Carried> carried(const Model& model, const State& state,
                                             std::span<const double> memory) const override;
  void add_rounding_forces(const Model& model, double extent, std::span<double> force) const override;

 private:
  static constexpr std::size_t bars_of_beam = 4, link_numbers = 4;
  enum class Bond { held, broken, gone };
  /// Where a bar lies.
  struct Bar {
    Vec2 along;
    double length = 0.0;
  };
  /// m, by which a bar is longer than without force. memory: what it was longer by than before the run when it was put on.
  [[nodiscard]] double stretch_of(const Model& model, const State& state, std::size_t bar,
                                  std::span<const double> memory) const {
    return bar_of(model, state, bar).length - rest_[bar] - memory[bar];
  }
  /// A link: how far the rock is from the liner since it was put on.
  struct Way {
    double out = 0.0;    ///< m, opening
    double along = 0.0;  ///< m, slip and what is elastic of it
  };

  [[nodiscard]] std::size_t bars() const { return bars_of_beam * beams_.size(); }
  [[nodiscard]] const loading::Liner& liner_of(std::size_t station) const {
    return liners_[stations_[station].liner];
  }
  [[nodiscard]] bool is_there(const State& state, std::size_t station) const {
    const int staged = liner_of(station).staged;
    return staged < 0 || state.installed[static_cast<std::size_t>(staged)] != 0;
  }
  // Points of a station: its outer node, its inner node, its outer face; then the rock of each link.
  [[nodiscard]] std::size_t point_of(std::size_t station, std::size_t which) const {
    return 3 * station + which;
  }
  [[nodiscard]] std::size_t rock_of(std::size_t link) const { return 3 * stations_.size() + link; }
  /// The points of bar `which` of a beam: 0 and 1 chords, 2 and 3 diagonals from the outer and the inner node.
  [[nodiscard]] std::pair<std::size_t, std::size_t> ends_of(std::size_t beam, std::size_t which) const;
  [[nodiscard]] double stiffness_of(std::size_t beam, std::size_t which) const;
  [[nodiscard]] double strut_stiffness(std::size_t station) const;
  [[nodiscard]] double half_height(std::size_t station) const;
  [[nodiscard]] Vec2 place_of(const Model& model, const std::vector<double>& coefficients,
                              std::size_t point) const;
  [[nodiscard]] Bar bar_of(const Model& model, const State& state, std::size_t bar) const;
  [[nodiscard]] double strut_stretch(const Model& model, const State& state, std::size_t station,
                                     Vec2& out) const;

  // Numbers of a link in the memory: what it was open and slipped by when it was put on, its slip, its bond.
  [[nodiscard]] std::size_t at_link(std::size_t link, std::size_t number) const {
    return bars() + link_numbers * link + number;
  }
  [[nodiscard]] Bond bond_of(std::size_t link, std::span<const double> memory) const {
    const Bond bond = static_cast<Bond>(static_cast<int>(memory[at_link(link, 3)]));
    return bond == Bond::held && !may_hold(links_[link].station) ? Bond::broken : bond;
  }
  /// Whether there is anything that breaks.
  [[nodiscard]] bool may_hold(std::size_t station) const {
    return liner_of(station).adhesion > 0.0 || liner_of(station).cohesion > 0.0;
  }
  [[nodiscard]] bool holds(const Model& model, const State& state, std::size_t link,
                           std::span<const double> memory) const;
  [[nodiscard]] Vec2 out_of(const Model& model, const State& state, std::size_t station) const;
  [[nodiscard]] Way way_of(const Model& model, const State& state, std::size_t link, Vec2 out) const;
  [[nodiscard]] Way way_since(const Model& model, const State& state, std::size_t link, Vec2 out,
                              std::span<const double> memory) const;
  [[nodiscard]] double link_energy(std::size_t link, Way way, Bond bond) const;
  [[nodiscard]] SpringArray::Force link_force(std::size_t link, Way way, Bond bond) const;
  void put(const Model& model, State& state, std::size_t station, Vec2 wall, Vec2 out, Vec2 velocity) const;
  /// Of stations with rock.
  [[nodiscard]] LinerWay way_of_rock(const Model& model, const State& state,
                                     std::span<const std::uint8_t> is_put) const;
  void put_all(const Model& model, State& state, std::span<const std::uint8_t> is_put) const;
  void account_for_bar(const Attempt& attempt, std::size_t first, std::size_t bar,
                       std::span<const double> memory, State& state) const;
  void account_for_link(const Attempt& attempt, std::size_t first, std::size_t link, std::span<double> memory,
                        State& state) const;
  void account_for_station(const Attempt& attempt, std::size_t station, State& state) const;
  /// At both ends of a beam.
  [[nodiscard]] std::pair<loading::SectionForce, loading::SectionForce> forces_of(
      const Model& model, const State& state, std::size_t beam, std::span<const double> memory) const;

  std::vector<loading::Liner> liners_;
  std::vector<LinerStation> stations_;
  std::vector<LinerBeam> beams_;
  std::vector<LinerLink> links_;
  std::vector<MaterialPoint> points_;
  std::vector<double> rest_;  ///< m, of every bar, before the run
};

}  // namespace keyblock::dynamics
