#include "study/limit_criterion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "scenario/key_path.h"
#include "scenario/sections.h"
#include "study/measures.h"
#include "study/refusal.h"

namespace keyblock::study {
namespace {

using record::StageKind;
using record::Standing;

constexpr const char* distance_measure = "displacement_max_m";
constexpr const char* distance_in_stage = "stage_displacement_m";
/// Of the block size, that rock goes in a stage before it has given way.
constexpr double way_share = 0.002;

// Of the size of the rock: an outline that comes so near to its edge reaches it.
constexpr double at_the_edge = 1e-6;

constexpr const char* is_named = "a static stage names what moves without bound, and holds it there";
constexpr const char* comes_down =
    "rock that only loosens still bears; what comes down into the opening is asked for";

constexpr LimitDefault defaults[] = {
    {LimitModel::structure, LimitEnd::settled, "a structure, to equilibrium", "collapsed", is_named},
    {LimitModel::structure, LimitEnd::in_motion, "a structure in motion", "collapsed",
     "what falls or goes on sliding does not stand"},
    {LimitModel::structure, LimitEnd::shaken, "a structure that is shaken", "collapsed",
     "what rocks comes to rest again; what falls or goes on sliding does not"},
    {LimitModel::slope, LimitEnd::settled, "a slope, to equilibrium", "collapsed", is_named},
    {LimitModel::slope, LimitEnd::in_motion, "a slope in motion", "collapsed",
     "a slope that slides has failed, long before its rock has gone as far as a fall"},
    {LimitModel::slope, LimitEnd::shaken, "a slope that is shaken", "moved",
     "it slides as long as the shaking is strong enough, and stops: how far is what counts"},
    {LimitModel::tunnel, LimitEnd::settled, "an opening, to equilibrium", "collapsed", is_named},
    {LimitModel::tunnel, LimitEnd::in_motion, "an opening in motion", "fallen", comes_down},
    {LimitModel::tunnel, LimitEnd::shaken, "an opening that is shaken", "fallen", comes_down}};

}  // namespace

std::string LimitCriterion::text() const {
  const Measure& m = measures()[find_measure(measure).value()];
  if (!by_measure) return "blocks that do not stand";
  const std::string also = by_standing ? "blocks that do not stand, or " : "";
  if (above_share)
    return fmt::format("{}{} of more than {:.3g} % of the block size", also, m.title, 100.0 * *above_share);
  return fmt::format("{}{} of more than {:.6g}{}{}", also, m.title, above, m.unit.empty() ? "" : " ", m.unit);
}

bool LimitCriterion::is_met(double measured, double block_size, const StageMeasures& deciding) const {
  if (by_standing && deciding.standing != Standing::stands && deciding.standing != Standing::rocks)
    return true;
  if (!by_measure) return false;
  const bool goes_on = deciding.kind == StageKind::settle && deciding.standing == Standing::moves;
  return measured > (above_share ? *above_share * block_size : above) ||
         (goes_on && measure == distance_measure);
}

const StageMeasures& deciding_stage(const RunResult& run) {
  const StageMeasures& last = run.stages.at(run.stages.size() - 1);
  if (last.standing != Standing::stands && last.standing != Standing::rocks) return last;
  const auto is_static = [](const StageMeasures& stage) { return stage.kind == StageKind::settle; };
  const auto settled = std::find_if(run.stages.rbegin(), run.stages.rend(), is_static);
  return settled != run.stages.rend() && settled->standing == Standing::moves ? *settled : last;
}

LimitCriterion limit_criterion(const std::string& name, std::optional<double> above, double loosened) {
  LimitCriterion criterion{.name = name, .measure = name, .above = above.value_or(0.0)};
  if (name == "fallen") {
    criterion.measure = "fallen_area_m2";
  } else if (name == "moved") {
    criterion.measure = distance_measure;
    criterion.above = above.value_or(loosened);
  } else if (name == "collapsed") {
    criterion.measure = distance_measure;
    criterion.by_measure = false;
    criterion.by_standing = true;
    if (above)
      refuse("--above", fmt::format("{}", *above), "nothing, as collapsed has no threshold",
             "--until fallen, moved or a measure such as loosened_area_m2 has one");
  } else if (name == "gives_way") {
    criterion.measure = distance_in_stage;
    criterion.by_standing = true;
    if (!above) criterion.above_share = way_share;
  } else if (!find_measure(name)) {
    std::vector<std::string> words{"fallen", "moved", "collapsed", "gives_way"};
    for (const Measure& m : measures()) words.push_back(m.name);
    const std::string hint = scenario::suggestion(name, words);
    refuse("--until", '"' + name + '"', "fallen, moved, collapsed, gives_way or a measure of summary.json",
           hint);
  }
  if (!std::isfinite(criterion.above)) refuse("--above", fmt::format("{}", criterion.above), "a number");
  return criterion;
}

LimitModel limit_model(const scenario::Scenario& scenario) {
  if (scenario.excavations.empty()) return LimitModel::structure;
  Box rock = scenario::box_of_model(scenario);
  const double near = at_the_edge * std::max(rock.size().x, rock.size().y);
  const auto reaches_edge = [&](const scenario::ExcavationSpec& spec) {
    const Box opening = bounds(Polygon{scenario::excavation_outline(spec), {}});
    return opening.min.x <= rock.min.x + near || opening.min.y <= rock.min.y + near ||
           opening.max.x >= rock.max.x - near || opening.max.y >= rock.max.y - near;
  };
  return std::any_of(scenario.excavations.begin(), scenario.excavations.end(), reaches_edge)
             ? LimitModel::slope
             : LimitModel::tunnel;
}

LimitEnd limit_end(const scenario::Scenario& scenario) {
  if (scenario.stages.back().kind == StageKind::settle) return LimitEnd::settled;
  const bool is_shaken =
      std::any_of(scenario.stages.begin(), scenario.stages.end(),
                  [](const record::Stage& stage) { return stage.kind == StageKind::shake; }) ||
      std::any_of(scenario.blocks.begin(), scenario.blocks.end(), [](const scenario::BlockSpec& block) {
        return !block.motion_x.empty() || !block.motion_y.empty();
      });
  return is_shaken ? LimitEnd::shaken : LimitEnd::in_motion;
}

std::span<const LimitDefault> limit_defaults() {
  return defaults;
}

const LimitDefault& limit_default(const scenario::Scenario& scenario) {
  const LimitModel model = limit_model(scenario);
  const LimitEnd end = limit_end(scenario);
  return *std::find_if(std::begin(defaults), std::end(defaults),
                       [&](const LimitDefault& row) { return row.model == model && row.end == end; });
}

bool needs_rest(const LimitCriterion& criterion, const scenario::Scenario& scenario) {
  const record::Stage& last = scenario.stages.back();
  const bool waits = last.kind == StageKind::rest && last.until_still;
  return criterion.by_standing && !waits && limit_end(scenario) == LimitEnd::shaken;
}

}  // namespace keyblock::study
