#include <fmt/format.h>

#include <algorithm>

#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using record::Sides;

constexpr Word<bool> bases[] = {{"compliant", true}, {"rigid", false}};
constexpr Word<bool> tops[] = {{"free", false}, {"overburden", true}};
constexpr Word<Sides> kinds_of_sides[] = {{"free-field", Sides::free_field},
                                          {"viscous", Sides::viscous},
                                          {"roller", Sides::roller},
                                          {"frame", Sides::frame}};

Rule speed(std::string_view meaning, bool required, std::string_view fallback) {
  return {.meaning = meaning,
          .unit = "m/s",
          .required = required,
          .above = 0.0,
          .fallback = fallback,
          .usual = &usual::speed};
}

/// A solid keeps its volume (bulk modulus above 0) only where v_p² > 4/3 v_s². Poisson's ratio is not negative where v_p ≥ √2 v_s.
void check_speeds(TableReader& t, const std::optional<double>& vs, const std::optional<double>& vp) {
  constexpr double least_ratio = 1.1547;  // √(4/3)
  if (!vs || !vp || *vp > least_ratio * *vs) return;
  t.fail("vp", fmt::format("{} m/s, {:.4g} of vs = {} m/s", *vp, *vp / *vs, *vs),
         "a speed of pressure waves above 1.155 of that of shear waves: below, the rock would be no solid");
}

void read_layer(TableReader& t, RockLayerSpec& layer) {
  layer.path = t.path();
  t.number(
      "top", layer.top,
      {.meaning = "Height of its top; the first layer also holds above.", .unit = "m", .required = true});
  t.number(
      "density", layer.density,
      {.meaning = "Density.", .unit = "kg/m³", .required = true, .above = 0.0, .usual = &usual::density});
  const bool vs = t.number("vs", layer.vs, speed("Speed of shear waves.", true, ""));
  const bool vp = t.number("vp", layer.vp, speed("Speed of pressure waves.", true, ""));
  if (vs && vp) check_speeds(t, layer.vs, layer.vp);
}

void check_order(TableReader& t, const std::vector<RockLayerSpec>& layers) {
  for (std::size_t k = 1; k < layers.size(); ++k) {
    if (layers[k].top < layers[k - 1].top) continue;
    t.fail("column",
           fmt::format("a layer with top = {} under one with top = {}", layers[k].top, layers[k - 1].top),
           "layers from above");
    return;
  }
}

/// What is fixed stays where the outcrop is; over a compliant base the ground moves against it.
void check_fixed_blocks(TableReader& t, const Scenario& scenario, const BoundarySpec& boundary) {
  if (!boundary.compliant || t.documenting()) return;
  for (const BlockSpec& block : scenario.blocks) {
    if (!block.fixed) continue;
    t.fail("base", fmt::format("\"compliant\" with the fixed block {}", block.path),
           "\"rigid\", or blocks that are not fixed: what is fixed would move with the outcrop");
    return;
  }
}

/// The half-space below the model.
void read_half_space(TableReader& t, BoundarySpec& boundary, bool applies) {
  const auto below = [&](Rule rule) {
    rule.applies = applies;
    rule.condition = "base = \"compliant\"";
    return rule;
  };
  constexpr std::string_view of_model = "that of the rock at the base";
  t.number("density", boundary.density,
           below({.meaning = "Density of the half-space below.",
                  .unit = "kg/m³",
                  .above = 0.0,
                  .fallback = of_model,
                  .usual = &usual::density}));
  t.number("vs", boundary.vs, below(speed("Its speed of shear waves.", false, of_model)));
  t.number("vp", boundary.vp, below(speed("Its speed of pressure waves.", false, of_model)));
  check_speeds(t, boundary.vs, boundary.vp);
}

void read_boundary_keys(TableReader& t, Scenario& scenario) {
  BoundarySpec& boundary = scenario.boundary.emplace();
  const bool documenting = t.documenting();
  t.word("base", boundary.compliant, bases,
         {.meaning = "`compliant`: a half-space, into which waves go down; motions are those of an outcrop. "
                     "`rigid`: the base does what the motion says."});
  t.word(
      "sides", boundary.sides, kinds_of_sides,
      {.meaning =
           "`free-field`: the rock far away, which moves as it would without the model. `viscous`: rock at "
           "rest that takes up waves, for sources inside. `roller`: held across, free along. `frame`: fixed "
           "blocks all around, as [domain] boundary = \"frame\"."});
  const bool around = documenting || boundary.sides != Sides::frame;
  t.word(
      "top", boundary.overburden, tops,
      {.meaning =
           "`free`: the ground. `overburden`: the model ends below the ground, under the weight of the rock "
           "of [in_situ] depth.",
       .applies = around,
       .condition = "sides other than \"frame\""});
  read_half_space(t, boundary, documenting || (around && boundary.compliant));
  t.tables("column", boundary.column,
           {.meaning = "Layers of the rock beside the model, from above.",
            .fallback = "that of the blocks at the sides, with their joints",
            .applies = around,
            .condition = "sides other than \"frame\""},
           read_layer);
  check_order(t, boundary.column);
  t.number("frequency", boundary.frequency,
           {.meaning = "Up to it waves beside the model are followed.",
            .unit = "Hz",
            .above = 0.0,
            .applies = around,
            .condition = "sides other than \"frame\"",
            .usual = &usual::frequency});
  const bool free_field = documenting || boundary.sides == Sides::free_field;
  t.boolean(
      "planes", boundary.planes,
      {.meaning = "Joints through the whole model that are at most 10° steep go on in the rock beside it, "
                  "and slip there as well; else that rock is elastic.",
       .applies = free_field,
       .condition = "sides = \"free-field\""});
  if (documenting) return;
  if (!around && boundary.compliant)
    t.fail("sides", "\"frame\" with a compliant base", "base = \"rigid\", or \"free-field\" sides");
  if (!around && !scenario.domain)
    t.fail("sides", "\"frame\" without [domain]", "[domain], which the frame is around");
  check_fixed_blocks(t, scenario, boundary);
}

}  // namespace

void read_boundary(TableReader& root, Scenario& scenario) {
  const bool given = root.table(
      "boundary",
      {.meaning = "The rock around the model, which waves go out through. In place of [domain] boundary."},
      [&](TableReader& t) { read_boundary_keys(t, scenario); });
  if (root.documenting()) {
    scenario.boundary.reset();
    return;
  }
  if (!given || !scenario.boundary) return;
  const Value* domain = root.find("domain");
  if (domain != nullptr && domain->find("boundary") != nullptr)
    root.fail_at(*domain->find("boundary"), "domain.boundary", "a value beside [boundary]", "one of the two");
  if (scenario.domain) scenario.domain->frame = scenario.boundary->sides == Sides::frame;
  if (scenario.boundary->overburden && root.find("in_situ") == nullptr)
    root.fail_at(*root.find("boundary")->find("top"), "boundary.top", "\"overburden\" without [in_situ]",
                 "[in_situ], whose stress acts on the top");
}

}  // namespace keyblock::scenario
