// `pattern` of [[trace_map]]: joints by a rule.
#include <utility>

#include "scenario/polygon_checks.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr Word<rockmass::Tessellation::Pattern> patterns[] = {
    {"brick", rockmass::Tessellation::Pattern::brick}, {"voronoi", rockmass::Tessellation::Pattern::voronoi}};

}  // namespace

void read_tessellation(TableReader& t, std::optional<rockmass::Tessellation>& read) {
  using Pattern = rockmass::Tessellation::Pattern;
  rockmass::Tessellation tessellation;
  std::optional<Pattern> pattern;
  t.word("pattern", pattern, patterns,
         {.meaning = "Joints by a rule, in place of a file: courses of bricks, or a Voronoi tessellation, "
                     "which differs by "
                     "realization.",
          .fallback = "file"});
  const bool any = t.documenting() || t.find("pattern") != nullptr;
  const bool brick = t.documenting() || (any && pattern != Pattern::voronoi);
  const bool voronoi = t.documenting() || (any && pattern != Pattern::brick);
  const bool region = t.ring(
      "region", tessellation.region,
      only(any, "pattern",
           {.meaning = "Where it is, with its outline a joint.", .unit = "m", .fallback = "the domain"}));
  Polygon polygon{tessellation.region, {}};
  if (const auto fault = region ? orient_and_check(polygon) : std::nullopt)
    t.fail("region", fault->text, "a ring that encloses an area and does not cross itself");
  tessellation.region = std::move(polygon.outer);
  const bool size = t.number("size", tessellation.size,
                             only(any, "pattern",
                                  {.meaning = "Length of a brick; root of the mean area of a Voronoi block.",
                                   .unit = "m",
                                   .required = pattern.has_value() || t.documenting(),
                                   .above = 0.0,
                                   .usual = &usual::spacing}));
  const bool height = t.number("course_height", tessellation.course_height,
                               only(brick, "pattern = \"brick\"",
                                    {.meaning = "Height of a course.",
                                     .unit = "m",
                                     .required = pattern == Pattern::brick || t.documenting(),
                                     .above = 0.0,
                                     .usual = &usual::spacing}));
  t.number("bond", tessellation.bond,
           only(brick, "pattern = \"brick\"",
                {.meaning = "Share of a brick by which every second course is shifted.",
                 .at_least = 0.0,
                 .below = 1.0}));
  t.number("angle", tessellation.angle,
           only(brick, "pattern = \"brick\"",
                {.meaning = "By which the courses rise to the right.",
                 .unit = "°",
                 .at_least = -90.0,
                 .at_most = 90.0,
                 .usual = &usual::angle}));
  t.integer("rounds", tessellation.rounds,
            only(voronoi, "pattern = \"voronoi\"",
                 {.meaning = "How often each point goes to the centroid of its block: 0 leaves very unequal "
                             "blocks, 20 nearly hexagons.",
                  .at_least = 0,
                  .at_most = 100}));
  if (!pattern || !size || (*pattern == Pattern::brick && !height)) return;
  tessellation.pattern = *pattern;
  read = std::move(tessellation);
}

}  // namespace keyblock::scenario
