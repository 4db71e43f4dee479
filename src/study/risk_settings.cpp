#include <fmt/format.h>

#include "core/error.h"
#include "core/read_file.h"
#include "scenario/table_reader.h"
#include "study/plan.h"
#include "study/risk.h"

namespace keyblock::study {
namespace {

using scenario::TableReader;
using scenario::Word;

constexpr Word<const char*> components[] = {{"rotd50", "rotd50"},
                                            {"rotd100", "rotd100"},
                                            {"geometric-mean", "geometric-mean"},
                                            {"larger", "larger"},
                                            {"section", "section"}};

void read_hazard_table(TableReader& t, HazardSource& source, const std::string& settings) {
  hazard::HazardOptions& options = source.options;
  options.from = settings;
  t.file("file", source.file, {.meaning = "The hazard curve.", .required = true});
  std::optional<Vec2> site;
  t.point("site", site,
          {.meaning = "Longitude and latitude, where the file has several sites.", .unit = "°"});
  if (site) options.site = std::pair(site->x, site->y);
  t.string("intensity", options.intensity,
           {.meaning = "Its intensity, where the file does not say: `PGA`, `PGV`, `SA(0.3)`."});
  const char* component = "rotd50";
  t.word("component", component, components, {.meaning = "Of the horizontal shaking that the curve is of."});
  source.component = component;
  t.string("unit", options.unit,
           {.meaning = "Of the intensities of a table: `g`, `m/s2`, `cm/s2`, `m/s`, `cm/s`."});
  t.number("investigation_time", options.investigation_time,
           {.meaning = "Of a table of probabilities. Without it the numbers are annual rates.",
            .unit = "a",
            .above = 0.0});
  t.number("weight", source.weight, {.meaning = "Of this curve among several.", .above = 0.0});
}

}  // namespace

RiskSettings read_risk_settings(const std::filesystem::path& file) {
  const scenario::Value document = scenario::parse_toml(read_file(file), file.string());
  scenario::ReadContext context;
  context.directory = file.parent_path();
  TableReader root(context, &document);
  RiskSettings settings;
  root.number("lifetime", settings.lifetime, {.meaning = "Of the structure.", .unit = "a", .above = 0.0});
  root.number("sections", settings.sections,
              {.meaning = "Of the structure, each with rock of its own, under the same earthquakes.",
               .at_least = 1.0});
  root.tables("hazard", settings.hazards, {.meaning = "A hazard curve."},
              [&](TableReader& t, HazardSource& source) { read_hazard_table(t, source, file.string()); });
  root.finish();
  if (!context.mistakes.empty()) {
    context.mistakes.sort(file.string());
    throw context.mistakes.error();
  }
  return settings;
}

std::vector<Hazard> read_hazards(const RiskSettings& settings) {
  std::vector<Hazard> hazards;
  for (const HazardSource& source : settings.hazards) {
    hazards.push_back(
        {source, hash_text(read_file(source.file)), hazard::read_hazard(source.file, source.options)});
    const Hazard &first = hazards.front(), &now = hazards.back();
    if (now.found.intensity == first.found.intensity && now.source.component == first.source.component)
      continue;
    Diagnostic diagnostic;
    diagnostic.where.file = source.file.string();
    diagnostic.found = fmt::format("a hazard of {}, {}", now.found.intensity, now.source.component);
    diagnostic.expected = fmt::format("curves of one intensity and component: {}, {}", first.found.intensity,
                                      first.source.component);
    throw InputError(std::move(diagnostic));
  }
  return hazards;
}

}  // namespace keyblock::study
