#include <string>

#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using dynamics::DampingKind;

constexpr Word<DampingKind> kinds_of_damping[] = {
    {"stiffness", DampingKind::stiffness}, {"rayleigh", DampingKind::rayleigh}, {"mass", DampingKind::mass}};

/// The keys of [solver] damping. without_ground: as of read_damping.
void read_keys(TableReader& t, dynamics::RayleighDamping& damping, bool without_ground) {
  t.number("ratio", damping.ratio,
           {.meaning = "Share of critical damping, 0.02 for 2 %.",
            .required = true,
            .above = 0.0,
            .below = 1.0,
            .usual = &usual::damping});
  t.number("frequency", damping.frequency,
           {.meaning = "Where it has this ratio.",
            .unit = "Hz",
            .required = true,
            .above = 0.0,
            .usual = &usual::frequency});
  t.word(
      "kind", damping.kind, kinds_of_damping,
      {.meaning = "`stiffness`: of the strain of rock and joints, the more the faster they vibrate. `mass`: "
                  "of motion against the ground far away, the more the slower it is. `rayleigh`: half of "
                  "each, least at the frequency."});
  bool force = false;
  t.boolean("force", force,
            {.meaning = "Damping in proportion to mass slows falls and sliding. Without [boundary] it is "
                        "against the base, and only `force = true` allows it."});
  if (t.documenting() || !without_ground || force || damping.mass_rate() == 0.0) return;
  t.fail("kind",
         std::string(damping.kind == DampingKind::mass ? "\"mass\"" : "\"rayleigh\"") + " without [boundary]",
         "kind = \"stiffness\", or a seismic boundary, or force = true",
         "it also slows what falls, to a speed of g/α");
}

}  // namespace

void read_damping(TableReader& t, dynamics::SolverOptions& solver, bool without_ground) {
  dynamics::RayleighDamping damping;
  const bool given = t.table(
      "damping",
      {.meaning = "Damping of rock and joints by a ratio at a frequency. It takes the place of "
                  "rock_damping and contact_damping.",
       .group = "Damping",
       .group_meaning = "`[solver] damping`. What swings at a circular frequency ω loses ½ (α/ω + β ω) of "
                        "critical: α by mass, β by stiffness ([theory](theory.md#damping))."},
      [&](TableReader& d) { read_keys(d, damping, without_ground); });
  if (t.documenting() || !given) return;
  for (const std::string_view key : {"rock_damping", "contact_damping"}) {
    if (t.find(key) != nullptr) t.fail(key, "a value beside solver.damping", "one of the two");
  }
  solver.damping = damping;
  solver.rock_damping = solver.contact_damping = 0.0;
}

}  // namespace keyblock::scenario
