#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "contact/law.h"
#include "core/lanes.h"
#include "core/parallel.h"
#include "coupling/face_springs.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

/// The springs of all contacts of a step (contact::Spring), by component: what an open-close iteration reads of them and how far they
/// are stretched. Normal and shear spring of contact c give
///
///     N = clamp(k_n y, low, ∞)          T = clamp(k_s w, least, bound)
///
/// with penetration y and shear displacement w; low is 0, and −∞ for a bond, which also pulls; least is −bound, and of a row of another
/// coupling any number of at most 0. Their branches and lines are those of contact::ClampedSpring. Where rows share the pressure of faces, N has that beside it (`faces`).
class SpringArray {
 public:
  enum class Shear : std::int8_t { backward = -1, held = 0, forward = 1, none = 2 };
  /// The branch of the two piecewise linear laws that a contact is on.
  struct Branch {
    bool closed = false;        ///< the normal spring acts
    Shear shear = Shear::none;  ///< held: the shear spring acts; forward, backward: at the bound; none: T = 0
    /// Whether the same springs act.
    [[nodiscard]] bool same_springs(Branch other) const {
      return closed == other.closed && (shear == Shear::held) == (other.shear == Shear::held);
    }
    friend bool operator==(Branch, Branch) = default;
  };
  static_assert(sizeof(Branch) == sizeof(std::uint16_t) && std::has_unique_object_representations_v<Branch>);
  /// N and T.
  struct Force {
    double normal = 0.0, shear = 0.0;
    [[nodiscard]] bool is_zero() const { return normal == 0.0 && shear == 0.0; }
    friend Force operator-(Force a, Force b) { return {a.normal - b.normal, a.shear - b.shear}; }
  };

  void resize(std::size_t n) {
    size_ = n;
    for (std::vector<double>* v :
         {&kn, &ks, &bound, &least, &low, &friction, &constant, &y0, &w0, &slipped, &y, &w, &dy, &dw})
      v->resize(n + lane_count);  // as many as there are lanes can be loaded anywhere
    branch.resize(n);
    if (!faces.empty()) faces.begin(0);
    bounds_updated = false;
  }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// A row of a coupling other than contacts, at D = 0. Both springs push and pull, unless it has friction; 0: there is none.
  struct TwoSided {
    double normal_stiffness = 0.0, shear_stiffness = 0.0;  ///< N/m per thickness
    double least_shear = 0.0, largest_shear = 0.0;         ///< N per thickness; least ≤ 0 ≤ largest
    double normal = 0.0, shear = 0.0;                      ///< m, y₀ and w₀
    double friction =
        -1.0;  ///< of a row that presses alone, whose limits of shear are Coulomb's; −1: it is none
  };
  void set_row(std::size_t c, const TwoSided& row) {
    kn[c] = row.normal_stiffness;
    ks[c] = row.shear_stiffness;
    set_limits(c, row.least_shear, row.largest_shear);
    low[c] = row.friction < 0.0 ? -HUGE_VAL : 0.0;
    friction[c] = row.friction;
    constant[c] = slipped[c] = 0.0;
    y0[c] = y[c] = row.normal;
    w0[c] = w[c] = row.shear;
    branch[c] = branch_at(c, row.normal, row.shear);
  }

  /// tensile: a bond, which pulls.
  void set_law(std::size_t c, double largest_shear, bool tensile) {
    set_bound(c, largest_shear);
    low[c] = tensile ? -HUGE_VAL : 0.0;
  }
  void set_bound(std::size_t c, double largest_shear) { set_limits(c, -largest_shear, largest_shear); }
  /// Of the shear spring; where the largest is 0 there is none.
  void set_limits(std::size_t c, double least_shear, double largest_shear) {
    least[c] = least_shear;
    bound[c] = largest_shear;
  }
  [[nodiscard]] bool is_tensile(std::size_t c) const { return low[c] < 0.0; }

  using Law = contact::ClampedSpring<double>;
  using LawLanes = contact::ClampedSpring<Lanes>;
  [[nodiscard]] Law normal_law(std::size_t c) const { return {kn[c], low[c], HUGE_VAL}; }
  [[nodiscard]] Law shear_law(std::size_t c) const { return {ks[c], least[c], bound[c]}; }
  /// Of as many rows as there are lanes, from c on.
  [[nodiscard]] LawLanes normal_laws(std::size_t c) const {
    return {load(&kn[c]), load(&low[c]), broadcast(HUGE_VAL)};
  }
  [[nodiscard]] LawLanes shear_laws(std::size_t c) const {
    return {load(&ks[c]), load(&least[c]), load(&bound[c])};
  }
  /// N per thickness, the bound of shear by Coulomb's law where the normal spring presses with `normal`.
  [[nodiscard]] double strength(std::size_t c, double normal) const {
    return contact::shear_strength(friction[c], normal, constant[c]);
  }
  [[nodiscard]] Lanes strengths(std::size_t c, Lanes normal) const {
    return contact::shear_strength(load(&friction[c]), normal, load(&constant[c]));
  }

  /// The shear spring holds from where the step begins, not from where a velocity ends (ContactCoupling).
  void hold_from_start(std::size_t c) {
    w0[c] += slipped[c];
    w[c] += slipped[c];
    slipped[c] = 0.0;
  }
  /// Goes on along the direction of search; `branch` stays that of where it was.
  void go(double alpha, std::size_t begin, std::size_t end) {
    const auto add = [&](std::vector<double>& to, const std::vector<double>& change, std::size_t c,
                         int count) {
      store_first(&to[c], load_first(&to[c], count) + alpha * load_first(&change[c], count), count);
    };
    in_lanes(static_cast<int>(end - begin), [&](int first, int count) {
      add(y, dy, begin + static_cast<std::size_t>(first), count);
      add(w, dw, begin + static_cast<std::size_t>(first), count);
    });
  }

  [[nodiscard]] Branch branch_at(std::size_t c, double penetration, double displacement) const {
    const Law shear = shear_law(c);
    return {!normal_law(c).is_low(penetration), bound[c] <= 0.0               ? Shear::none
                                                : shear.is_high(displacement) ? Shear::forward
                                                : shear.is_low(displacement)  ? Shear::backward
                                                                              : Shear::held};
  }
  /// A branch that is known from elsewhere. A row that has no normal spring for itself is not closed by one.
  void set_branch(std::size_t c, Branch p) {
    p.closed = p.closed && kn[c] > 0.0;
    branch[c] = p;
  }
  /// As codes, of as many contacts as there are lanes; `held` where the shear spring is none of the others.
  [[nodiscard]] static LaneCondition codes_of(LaneCondition closed, LaneCondition none, LaneCondition forward,
                                              LaneCondition backward) {
    const auto code = [](Branch p) { return std::int64_t{std::bit_cast<std::uint16_t>(p)}; };
    return (closed & code({true, Shear::held})) | (none & code({false, Shear::none})) |
           (forward & code({false, Shear::forward})) | (backward & code({false, Shear::backward}));
  }
  /// Those of `count` contacts from c on.
  void set_branches(std::size_t c, std::size_t count, LaneCondition branches) {
    std::uint16_t codes[lane_count];
    store_codes(codes, branches);
    std::memcpy(static_cast<void*>(&branch[c]), &codes, count * sizeof(Branch));
  }
  /// branch_at of as many contacts as there are lanes, from c on.
  [[nodiscard]] LaneCondition branches_at(std::size_t c, Lanes penetration, Lanes displacement) const {
    const LawLanes shear = shear_laws(c);
    const auto none = shear.high <= 0.0, forward = ~none & shear.is_high(displacement),
               backward = ~none & ~forward & shear.is_low(displacement);
    return codes_of(~normal_laws(c).is_low(penetration), none, forward, backward);
  }
  /// Whether one of them leaves its `branch` by α along the direction of search; beyond the last one it may say so of none.
  [[nodiscard]] bool any_leaves(std::size_t c, double alpha) const {
    const Lanes a = broadcast(alpha);
    const auto now = branches_at(c, load(&y[c]) + a * load(&dy[c]), load(&w[c]) + a * load(&dw[c]));
    std::uint16_t codes[lane_count] = {};
    if (c + lane_count <= size_) {
      std::memcpy(&codes, &branch[c], sizeof(codes));
    } else {
      std::memcpy(&codes, &branch[c], (size_ - c) * sizeof(Branch));
    }
    return any(now != lane_codes(codes));
  }
  /// Stretches the springs of `count` contacts, at most as many as there are lanes, from c on, by a displacement of the two sides against
  /// each other along normal and tangent.
  void stretch(std::size_t c, std::size_t count, Lanes normal, Lanes tangent) {
    const Lanes penetration = load(&y0[c]) - normal, displacement = load(&w0[c]) + tangent;
    store_first(&y[c], penetration, static_cast<int>(count));
    store_first(&w[c], displacement, static_cast<int>(count));
    set_branches(c, count, branches_at(c, penetration, displacement));
  }
  [[nodiscard]] Force force_at(std::size_t c, double penetration, double displacement) const {
    return {normal_law(c).force(penetration), shear_law(c).force(displacement)};
  }
  /// Of all springs of the row, with its part of the pressure of faces.
  [[nodiscard]] Force force(std::size_t c) const {
    const Force own = force_at(c, y[c], w[c]);
    return {own.normal + faces.force(c), own.shear};
  }
  /// The normal forces of as many rows as there are lanes, likewise.
  [[nodiscard]] Lanes normal_forces(std::size_t c) const {
    return normal_laws(c).force(load(&y[c])) + faces.forces(c);
  }
  /// N per thickness, that the friction of a row goes with: its normal force, but of faces what it bears (FaceSprings::bearing).
  [[nodiscard]] double bearing(std::size_t c) const {
    return force_at(c, y[c], w[c]).normal + faces.bearing(c);
  }
  [[nodiscard]] Lanes bearings(std::size_t c) const {
    return normal_laws(c).force(load(&y[c])) + faces.bearings(c);
  }
  /// Whether nothing presses or pulls along the normal.
  [[nodiscard]] bool is_open(std::size_t c) const {
    return normal_law(c).is_low(y[c]) && !(faces.force(c) != 0.0);
  }
  /// N/m per thickness, of what acts along the normal where the row is closed.
  [[nodiscard]] double stiffness(std::size_t c) const { return kn[c] + faces.stiffness(c); }
  /// After y has changed.
  void press_faces() { faces.press(y); }
  /// On the straight line that goes on from a branch.
  [[nodiscard]] Force force_on(std::size_t c, Branch p, double penetration, double displacement) const {
    const double shear = p.shear == Shear::held      ? ks[c] * displacement
                         : p.shear == Shear::none    ? 0.0
                         : p.shear == Shear::forward ? bound[c]
                                                     : least[c];
    return {p.closed ? kn[c] * penetration : 0.0, shear};
  }
  /// Stiffness of a branch.
  [[nodiscard]] double normal_stiffness(std::size_t c, Branch p) const { return p.closed ? kn[c] : 0.0; }
  [[nodiscard]] double shear_stiffness(std::size_t c, Branch p) const {
    return p.shear == Shear::held ? ks[c] : 0.0;
  }

  std::vector<double> kn, ks;             ///< N/m per thickness
  std::vector<double> bound, least, low;  ///< N per thickness, largest T, least T and least N
  std::vector<double> friction;           ///< μ; −1: the bound is not Coulomb's
  /// N per thickness, of the bound μN + this: the cohesion of a bond, the friction that a contact owes.
  std::vector<double> constant;
  std::vector<double> y0, w0;   ///< m, at D = 0
  std::vector<double> slipped;  ///< m, slip of the step that w does not have
  std::vector<double> y, w;     ///< m, now
  std::vector<double> dy, dw;   ///< m, of the direction of search
  std::vector<Branch> branch;   ///< of (y, w), of the springs that the rows have for themselves
  FaceSprings faces;
  bool bounds_updated = false;  ///< bounds are no more those of the last step

 private:
  std::size_t size_ = 0;
};

/// N per thickness, of the row that presses or pulls most; 0: none does.
inline double largest_normal_force(const SpringArray& springs, ThreadTeam& team) {
  constexpr std::size_t width = lane_count;
  return largest_of(team, (springs.size() + width - 1) / width, contacts_worth_threads / width,
                    [&](std::size_t group) {
                      const std::size_t c = group * width;
                      const Lanes zero{}, force = springs.normal_forces(c);
                      return largest(where(first_lanes(springs.size() - c), largest(force, -force), zero));
                    });
}

/// N/m per thickness, of the stiffest normal spring; 0: there is none.
inline double largest_stiffness(const SpringArray& springs, ThreadTeam& team) {
  constexpr std::size_t width = lane_count;
  double most = largest_of(
      team, (springs.size() + width - 1) / width, contacts_worth_threads / width, [&](std::size_t group) {
        const std::size_t c = group * width;
        return largest(where(first_lanes(springs.size() - c), load(&springs.kn[c]), Lanes{}));
      });
  for (const std::size_t c : springs.faces.all_rows()) most = std::max(most, springs.stiffness(c));
  return most;
}

}  // namespace keyblock::dynamics
