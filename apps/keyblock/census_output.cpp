#include "census_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace keyblock::app {
namespace {

using census::KeyBlock;
using census::Mode;

constexpr double kilo = 1e3;

std::string row(const study::RealizationCensus& census, std::size_t k) {
  const KeyBlock& key = census.census.blocks[k];
  const std::string layer = key.moves() ? std::to_string(key.layer) : "stays",
                    name = census.names[k].empty() ? std::to_string(key.block) : census.names[k];
  return fmt::format("{:>6} {:>7} {:>9.4g} {:>8.3g} {:>12.4g} {:>7.4g} {:>11.4g}  {}{}{}\n", layer, name,
                     key.area, key.depth, key.weight / kilo, key.removal.factor(), key.force / kilo,
                     census::mode_name(key.removal.mode), census.joints[k].empty() ? "" : ": ",
                     fmt::join(census.joints[k], ", "));
}

std::string sentence(const census::Census& census, double wanted_factor) {
  const census::Totals sum = census::totals(census);
  const auto with = [&](Mode mode) { return sum.by_mode[static_cast<std::size_t>(mode)]; };
  std::string text = fmt::format("No block moves around {:.4g} m of wall", census.wall);
  if (sum.moving > 0)
    text = fmt::format(
        "Blocks that move: {}, in {} layer{}; {:.4g} m² around {:.4g} m of wall, {:.3g} m² per metre; the "
        "largest has {:.4g} m² and is {:.3g} m deep",
        sum.moving, census.layers, census.layers == 1 ? "" : "s", sum.area, census.wall,
        sum.area / census.wall, sum.largest_area, sum.largest_depth);
  return fmt::format(
      "{}.\nOf those that stay at a free face {} are below F = {:g}, {} are stable and {} not removable.\n",
      text, sum.supported, wanted_factor, with(Mode::stable), with(Mode::not_removable));
}

}  // namespace

std::string census_table(const study::RealizationCensus& census, double wanted_factor) {
  std::string rows;
  for (std::size_t k = 0; k < census.census.blocks.size(); ++k) {
    const KeyBlock& key = census.census.blocks[k];
    if (key.moves() || key.force > 0.0) rows += row(census, k);
  }
  const std::string head = fmt::format("{:>6} {:>7} {:>9} {:>8} {:>12} {:>7} {:>11}  {}\n", "layer", "block",
                                       "area m²", "depth m", "weight kN/m", "F", "force kN/m", "mode");
  return (rows.empty() ? "" : head + rows) + sentence(census.census, wanted_factor);
}

std::string censuses_table(const study::CensusStudy& study) {
  std::string text = fmt::format("{} realizations, intervals of {:g} %\n{:<38} {:>10} {:>23} {:>10} {:>10}\n",
                                 study.realizations.size() - study.failed(), 100.0 * study.confidence, "",
                                 "mean", "interval", "least", "most");
  for (std::size_t m = 0; m < study.measures.size(); ++m) {
    const study::CensusMeasure& measure = study::census_measures()[m];
    const statistics::Description& d = study.measures[m];
    const std::string unit = *measure.unit == '\0' ? "" : fmt::format(" ({})", measure.unit),
                      interval = std::isnan(d.mean.low)
                                     ? "?"
                                     : fmt::format("{:.4g} … {:.4g}", d.mean.low, d.mean.high);
    text += fmt::format("{:<38} {:>10.4g} {:>23} {:>10.4g} {:>10.4g}\n", measure.title + unit, d.mean.value,
                        interval, d.min, d.max);
  }
  return text;
}

std::vector<cutting::BlockPaint> census_paint(const census::Census& census, double wanted_factor) {
  // Dark to light, so that they differ without colours.
  std::vector<cutting::BlockPaint> paint{{"falls", "#d9604c", {}},
                                         {"slides", "#f0a860", {}},
                                         {fmt::format("below F = {:g}", wanted_factor), "#f8e3a0", {}}};
  for (const KeyBlock& key : census.blocks) {
    if (key.moves()) {
      paint[key.removal.mode == Mode::falls ? 0 : 1].blocks.push_back(key.block);
    } else if (key.force > 0.0) {
      paint[2].blocks.push_back(key.block);
    }
  }
  return paint;
}

}  // namespace keyblock::app
