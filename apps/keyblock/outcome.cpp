#include "outcome.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "record/before_shaking.h"
#include "record/computation_errors.h"
#include "record/energy_warnings.h"
#include "record/fallen.h"
#include "record/verdict.h"
#include "terminal.h"

namespace keyblock::app {
namespace {

using record::RunRecord;
using record::StageKind;
using record::StageRecord;

constexpr std::size_t table_columns = 9;
using Row = std::array<std::string, table_columns>;

constexpr double largest_overlap = 1e-3;  // m, that is none to speak of

constexpr double least_rotation = 0.01;  // degrees

// Units stand below, so that the table has room in a terminal.
const std::array<Row, 2> heading{
    Row{"stage", "steps", "time", "PGA", "fallen", "fallen", "loosened", "filled", "slip"},
    Row{"", "", "s", "m/s2", "blocks", "m2", "m2", "%", "mm"}};
constexpr int terminal_columns = 80, least_name = 8;

Row row(const StageRecord& stage) {
  const record::Damage& d = stage.damage;
  const bool dynamic = stage.stage.kind != StageKind::settle;
  return {one_line(stage.stage.name, 20, true),
          fmt::format("{}", stage.steps),
          dynamic ? fmt::format("{:.2f}", stage.duration) : "-",
          stage.stage.kind == StageKind::shake ? fmt::format("{:.2f}", stage.pga) : "-",
          fmt::format("{}", d.fallen_blocks),
          fmt::format("{:.2f}", d.fallen_area),
          fmt::format("{:.2f}", d.loosened_area),
          stage.standing ? "-" : fmt::format("{:.1f}", 100.0 * d.opening_filled_ratio),  // without an opening
          fmt::format("{:.2f}", 1000.0 * d.slip_max_ever)};
}

/// First column to the left, numbers to the right.
std::string aligned(const std::vector<Row>& rows) {
  std::array<int, table_columns> width{};
  for (const Row& r : rows) {
    for (std::size_t c = 0; c < table_columns; ++c) width[c] = std::max(width[c], column_count(r[c]));
  }
  // Names of stages take what the numbers leave.
  int room = terminal_columns;
  for (std::size_t c = 1; c < table_columns; ++c) room -= 2 + width[c];
  width[0] = std::min(width[0], std::max(least_name, room));
  std::string text;
  for (const Row& r : rows) {
    for (std::size_t c = 0; c < table_columns; ++c) {
      const std::string cell = c == 0 ? one_line(r[c], width[c], true) : r[c];
      const std::string padding(static_cast<std::size_t>(width[c] - column_count(cell)), ' ');
      if (c == 0) {
        text.append(cell).append(padding);
      } else {
        text.append("  ").append(padding).append(cell);
      }
    }
    text += '\n';
  }
  return text;
}

std::string moving_text(const StageRecord& stage) {
  std::string text = record::verdict_text(stage) + " (share of the weight that is carried:";
  constexpr std::size_t shown = 6;
  for (std::size_t k = 0; k < std::min(shown, stage.moving.size()); ++k) {
    text += fmt::format("{} block {} {:.0f} %", k == 0 ? "" : ",", stage.moving[k].block,
                        100.0 * stage.moving[k].carried);
  }
  return text + (stage.moving.size() > shown ? ", ...)" : ")");
}

std::string fallen_text(int blocks, double area) {
  return fmt::format("{} {} ({:.2f} m2)", blocks, blocks == 1 ? "block" : "blocks", area);
}

/// What came down before the shaking and what the shaking added; empty where nothing can come down, or nothing was shaken.
std::string split_at_shaking(const RunRecord& run) {
  std::vector<record::Stage> stages;
  for (const StageRecord& stage : run.stages) stages.push_back(stage.stage);
  const auto last = record::last_before_shaking(stages);
  if (!last) return "";
  const record::Damage &before = run.stages[*last].damage, &end = run.stages.back().damage;
  const bool open =
      std::any_of(stages.begin(), stages.end(), [](const record::Stage& s) { return !s.excavate.empty(); });
  if (!open && end.fallen_blocks == 0) return "";
  return fmt::format(
      "fallen before the shaking: {}; the shaking added {}\n",
      fallen_text(before.fallen_blocks, before.fallen_area),
      fallen_text(end.fallen_blocks - before.fallen_blocks, end.fallen_area - before.fallen_area));
}

std::string standing_text(const StageRecord& stage) {
  using record::Standing;
  switch (*stage.standing) {
    case Standing::stands:
      return "it stands";
    case Standing::moves:
      return stage.stage.kind == StageKind::settle
                 ? fmt::format("it moves ({})", record::verdict_text(stage))
                 : fmt::format("it moves, at up to {:.2g} m/s", stage.largest_speed);
    case Standing::rocks:
      return fmt::format(
          "it still rocks, at up to {:.2g} m/s; a stage of kind \"rest\" tells what comes of it",
          stage.largest_speed);
    case Standing::unstable:
      return fmt::format("it does not stand ({})", record::verdict_text(stage));
    case Standing::collapsed:
    case Standing::fallen:
      return fmt::format("it has collapsed: {} {} fallen", stage.damage.fallen_blocks,
                         stage.damage.fallen_blocks == 1 ? "block has" : "blocks have");
    case Standing::unsettled:
      break;
  }
  return "it is not known whether it stands";
}

/// Where the fallen rock came from.
std::string depths_text(const record::Damage& damage) {
  const std::pair<const char*, double> parts[] = {{"crown", damage.fallen_depth_crown},
                                                  {"left wall", damage.fallen_depth_left},
                                                  {"right wall", damage.fallen_depth_right},
                                                  {"invert", damage.fallen_depth_invert}};
  std::string text;
  for (const auto& [name, depth] : parts) {
    if (depth > 0.0) text += fmt::format("{}{} {:.2f} m", text.empty() ? "" : ", ", name, depth);
  }
  return text;
}

/// What has come of it all by the end; empty where there is nothing to say.
std::string result_text(const RunRecord& run, std::string_view scenario,
                        std::span<const std::string> openings) {
  if (run.stages.empty()) return {};
  const StageRecord& last = run.stages.back();
  const record::Damage& damage = last.damage;
  if (last.standing)
    return fmt::format(
        "at the end of \"{}\" {}; the middle of a block has moved by up to {:.4g} m, "
        "and a block turned by up to {} degrees\n",
        one_line(last.stage.name, 40, true), standing_text(last), damage.displacement_max,
        damage.rotation_max < least_rotation ? "0" : fmt::format("{:.3g}", damage.rotation_max));
  if (damage.fallen_blocks == 0 || std::isnan(damage.largest_block_pressure)) return {};
  std::string text = fmt::format(
      "fallen: {:.3g} kN per m of tunnel; largest block {:.3g} kN/m, {:.3g} kPa over its own width; from "
      "behind the {}\n",
      1e-3 * damage.fallen_weight, 1e-3 * damage.largest_fallen_weight, 1e-3 * damage.largest_block_pressure,
      depths_text(damage));
  const std::string search = record::pressure_search(scenario, openings, damage);
  if (!search.empty()) text += fmt::format("the support pressure that holds it: {}\n", search);
  return text;
}

/// Stages before a shaking one that were to last until all is still, and were not long enough.
std::vector<std::string> rests_that_were_too_short(const RunRecord& run) {
  std::vector<std::string> texts;
  for (std::size_t k = 0; k + 1 < run.stages.size(); ++k) {
    const StageRecord& stage = run.stages[k];
    if (!stage.stage.until_still || stage.still || stage.interrupted ||
        run.stages[k + 1].stage.kind != StageKind::shake)
      continue;
    texts.push_back(
        fmt::format("stage \"{}\" ended after {:.4g} s while rock still moved: what comes down later counts "
                    "as the earthquake's; a longer "
                    "duration tells the two apart",
                    stage.stage.name, stage.duration));
  }
  return texts;
}

std::vector<std::string> warnings(const RunRecord& run) {
  std::vector<std::string> texts;
  for (const StageRecord& stage : run.stages) {
    if (stage.interrupted) {
      texts.push_back(fmt::format("stage \"{}\" was interrupted", stage.stage.name));
    } else if (stage.stage.kind == StageKind::settle && !stage.moving.empty()) {
      texts.push_back(fmt::format("stage \"{}\": {}", stage.stage.name, moving_text(stage)));
    } else if (stage.stage.kind == StageKind::settle && !stage.equilibrium_reached) {
      texts.push_back(
          fmt::format("stage \"{}\" ended before equilibrium: worst residual {:.1e} of a block's weight",
                      stage.stage.name, stage.worst_residual_ratio));
    } else if (stage.stage.kind == StageKind::settle &&
               (record::verdict_of(stage) == record::Verdict::equilibrium_after_moving ||
                record::verdict_of(stage) == record::Verdict::unstable)) {
      texts.push_back(fmt::format("stage \"{}\" is {}", stage.stage.name, record::verdict_text(stage)));
    }
  }
  for (const std::string& text : rests_that_were_too_short(run)) texts.push_back(text);
  if (run.open_close.unconverged_steps > 0) {
    texts.push_back(fmt::format("{} steps did not converge", run.open_close.unconverged_steps));
  }
  for (const std::string& warning : record::energy_warnings(run)) texts.push_back(warning);
  const record::OverlapRecord& overlap = run.max_overlap;
  if (overlap.depth >= largest_overlap && overlap.block_a >= 0) {
    texts.push_back(
        fmt::format("blocks {} and {} overlap by {:.1f} mm at {:.2f} s, in stage \"{}\": a smaller time "
                    "step, or stiffer joints, may help",
                    overlap.block_a, overlap.block_b, 1000.0 * overlap.depth, overlap.time, overlap.stage));
  }
  return texts;
}

/// "most loaded spring: bolt 3, 118 kN/m in "shaking", 98 % of its limit; 2 of 12 springs have reached theirs". Empty: nothing of this kind carried.
std::string most_loaded_of(std::string_view kind, std::span<const record::ElementRecord> elements) {
  const record::ElementRecord* most = nullptr;
  long count = 0, yielded = 0;
  const auto load = [](const auto& of) { return std::pair(of.utilization(), of.peak_force); };
  for (const record::ElementRecord& e : elements) {
    if (e.kind != kind) continue;
    ++count;
    yielded += e.has_yielded() ? 1 : 0;
    if (most == nullptr || load(e) > load(*most)) most = &e;
  }
  if (most == nullptr || most->peak_stage.empty()) return "";
  std::string text = fmt::format("most loaded {}: {}, {:.4g} kN/m in \"{}\"", kind, most->name,
                                 most->peak_force / 1e3, most->peak_stage);
  if (std::isfinite(most->limit)) text += fmt::format(", {:.0f} % of its limit", 100.0 * most->utilization());
  // Stations of a liner have a strength of the section in the place of a limit of the force.
  if (kind == "liner") {
    const long off = std::ranges::count_if(
        elements, [&](const record::ElementRecord& e) { return e.kind == kind && e.ruptured; });
    if (most->utilization() > 0.0)
      text += fmt::format(", largest stress {:.0f} % of the strength", 100.0 * most->utilization());
    if (off > 0) text += fmt::format("; rock has come off at {} of {} stations", off, count);
    return text + "\n";
  }
  if (yielded > 0) text += fmt::format("; {} of {} {}s have reached theirs", yielded, count, kind);
  return text + "\n";
}

/// A line for each kind.
std::string most_loaded(const RunRecord& run) {
  std::string text;
  std::vector<std::string_view> kinds;
  for (const record::ElementRecord& e : run.elements) {
    if (std::ranges::find(kinds, e.kind) != kinds.end()) continue;
    kinds.push_back(e.kind);
    text += most_loaded_of(e.kind, run.elements);
  }
  return text;
}

}  // namespace

std::string outcome_text(const RunRecord& run, std::size_t block_count, std::string_view scenario,
                         std::span<const std::string> openings) {
  std::vector<Row> rows(heading.begin(), heading.end());
  for (const StageRecord& stage : run.stages) rows.push_back(row(stage));
  const double per_step = run.steps > 0 ? 1000.0 * run.wall_time / static_cast<double>(run.steps) : 0.0;
  std::string text = fmt::format(
      "{} blocks, {} degrees of freedom; {} steps in {:.1f} s: {:.2f} ms and {:.1f} open-close iterations "
      "per step\n"
      "largest overlap {:.3f} mm, energy residual {:.2f} %, state {}\n\n",
      block_count, run.dof, run.steps, run.wall_time, per_step, run.open_close.mean_iterations,
      1000.0 * run.max_overlap.depth, 100.0 * run.energy.residual_ratio, run.state_hash);
  text += aligned(rows);
  text += split_at_shaking(run);
  text += result_text(run, scenario, openings);
  text += most_loaded(run);
  for (const std::string& error : record::computation_errors(run))
    text += "error of the computation: " + error + "\n";
  for (const std::string& warning : warnings(run)) text += "note: " + warning + "\n";
  return text;
}

std::string profile_text(const RunRecord& run) {
  std::vector<std::size_t> order(phase_count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto entry = [&](std::size_t k) { return run.profile[static_cast<Phase>(k)]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return entry(a).seconds > entry(b).seconds; });
  double total = 0.0;
  for (const std::size_t k : order) total += entry(k).seconds;
  const double steps = static_cast<double>(std::max(1L, run.steps));
  std::string text =
      fmt::format("{:<13}  {:>8}  {:>5}  {:>7}  {:>10}\n", "where", "s", "%", "ms/step", "times/step");
  for (const std::size_t k : order) {
    text += fmt::format("{:<13}  {:>8.2f}  {:>5.1f}  {:>7.3f}  {:>10.2f}  {}\n", phase_names[k].key,
                        entry(k).seconds, 100.0 * entry(k).seconds / std::max(total, 1e-12),
                        1000.0 * entry(k).seconds / steps, static_cast<double>(entry(k).count) / steps,
                        phase_names[k].meaning);
  }
  return text;
}

}  // namespace keyblock::app
