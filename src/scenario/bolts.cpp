#include "scenario/bolts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact/candidates.h"
#include "core/error.h"
#include "scenario/key_path.h"
#include "simulation/bolt_nodes.h"
#include "simulation/build_bolts.h"
#include "simulation/history_block.h"
#include "simulation/outline_arc.h"

namespace keyblock::scenario {
namespace {

/// A straight part of the outline that has bolts.
struct Part {
  Vec2 from, to;

  [[nodiscard]] double length() const { return norm(to - from); }
  /// Away from the opening, of length 1.
  [[nodiscard]] Vec2 outwards() const { return Vec2{to.y - from.y, from.x - to.x} / length(); }
};

std::vector<Part> parts_of(const BoltSpec& spec, const Ring& outline) {
  std::vector<Part> parts;
  for (const auto& [from, to] : sides_of(spec.arc, outline)) parts.push_back({from, to});
  return parts;
}

/// Of a spacing: an outline of straight sides is a little shorter than the arc that it stands for, and has as many bolts.
constexpr double short_by = 0.02;

/// m along the parts, of every bolt.
std::vector<double> places_of(const BoltSpec& spec, double length) {
  const bool is_closed = !spec.arc;
  const double step = spec.spacing_along.value_or(0.0);
  int count = spec.count.value_or(0);
  double first = 0.0, apart = 0.0;
  if (step > 0.0) {
    count = is_closed ? std::max(1, static_cast<int>(std::lround(length / step)))
                      : 1 + static_cast<int>(std::floor(length / step + short_by));
    apart = is_closed ? length / count : step;
    first = is_closed ? 0.5 * apart : 0.5 * (length - (count - 1) * step);
  } else if (is_closed || count == 1) {
    apart = length / count;
    first = 0.5 * apart;
  } else {
    apart = length / (count - 1);
  }
  std::vector<double> places;
  for (int k = 0; k < count; ++k) places.push_back(std::clamp(first + k * apart, 0.0, length));
  return places;
}

[[noreturn]] void refuse_bolt(const Scenario& scenario, const std::string& key, std::string found,
                              std::string expected) {
  throw InputError(Diagnostic{scenario.where(key), key, std::move(found), std::move(expected), ""});
}

/// The pieces of bolt k. Mistakes show at the keys of its [[bolt]].
std::vector<simulation::BoltPiece> pieces_of(const Scenario& scenario, const simulation::RunSetup& setup,
                                             std::size_t k, const BoltSpec& spec) {
  try {
    return simulation::bolt_pieces(setup, k);
  } catch (const InputError& error) {
    const Diagnostic& mistake = error.diagnostics().front();
    const bool is_toe = mistake.key.ends_with(".to"), is_pattern = spec.excavation >= 0;
    const char* head = is_pattern ? "excavation" : "from";
    const char* toe = is_pattern ? "length" : "to";
    refuse_bolt(
        scenario, join_path(join_path("bolt", spec.bolt.list), is_toe ? toe : head),
        fmt::format("the {} of {} at {}", is_toe ? "toe" : "head", setup.bolts[k].name, mistake.found),
        mistake.expected);
  }
}

/// m, from a point in a block to its outline.
double depth_in(const Polygon& block, Vec2 point) {
  double nearest = HUGE_VAL;
  for (std::size_t r = 0; r <= block.holes.size(); ++r) {
    const Ring& ring = block.ring(r);
    for (std::size_t k = 0; k < ring.size(); ++k)
      nearest = std::min(nearest, contact::distance_to_segment(point, ring[k], ring[(k + 1) % ring.size()]));
  }
  return nearest;
}

/// The place of a bolt among the stages: installed before the opening is there that it is a pattern of.
bool is_before_its_opening(const simulation::RunSetup& setup, const loading::Bolt& bolt, int excavation) {
  for (const record::Stage& stage : setup.stages) {
    if (std::ranges::find(stage.excavate, excavation) != stage.excavate.end()) return bolt.staged < 0;
    if (std::ranges::find(stage.install, bolt.list) != stage.install.end()) return true;
  }
  return false;
}

/// What seems odd with the bolts of one [[bolt]].
class OddBolts {
 public:
  void see(const simulation::RunSetup& setup, const loading::Bolt& bolt,
           const std::vector<simulation::BoltPiece>& pieces) {
    ++count_;
    // A head in the wall lies on the outline of its block.
    const double depth = depth_in(setup.system.blocks[pieces.front().block].polygon, bolt.head);
    if (bolt.has_plate && depth > most_depth_of_a_head * bolt.length())
      keep(deep_, fmt::format("the plate of {} lies {:.3g} m inside of the rock", bolt.name, depth));
    idle_ += pieces.size() == 1 ? 1 : 0;
    if (const std::size_t nodes =
            simulation::bolt_nodes(setup, static_cast<std::size_t>(&bolt - setup.bolts.data())).size();
        nodes > many_nodes)
      keep(long_, fmt::format("{} has {} nodes, which makes steps slow", bolt.name, nodes));
    for (std::size_t j = 0; j + 1 < pieces.size(); ++j) {
      if (pieces[j + 1].from - pieces[j].to > 1e-3 * bolt.length()) keep(crosses_, bolt.name);
    }
    for (const simulation::BoltPiece& piece : pieces) {
      if (const auto stage = simulation::excavating_stage(setup, piece.block)) {
        keep(ends_, fmt::format("{} crosses rock that the stage '{}' excavates, and ends", bolt.name,
                                setup.stages[*stage].name));
      }
    }
  }
  void warn(const std::string& path, std::vector<std::string>& warnings) const {
    if (idle_ > 0)
      warnings.push_back(
          fmt::format("{}: {} of {} bolts cross no joint, and do nothing", path, idle_, count_));
    if (!crosses_.empty())
      warnings.push_back(fmt::format("{}: {} crosses an opening; its bar is free there", path, crosses_));
    if (!deep_.empty())
      warnings.push_back(fmt::format("{}: {}; `from` is the head, at the wall", path, deep_));
    if (!long_.empty())
      warnings.push_back(fmt::format("{}: {}; a larger node_spacing takes less time", path, long_));
    if (!ends_.empty()) warnings.push_back(fmt::format("{}: {} there", path, ends_));
  }

 private:
  static void keep(std::string& first, std::string text) {
    if (first.empty()) first = std::move(text);
  }

  static constexpr std::size_t many_nodes = 200;
  static constexpr double most_depth_of_a_head = 0.02;  // of the length of a bolt

  int count_ = 0, idle_ = 0;
  std::string crosses_, ends_, deep_, long_;  ///< of the first
};

/// A bar of 25 mm that carries 4 MN is no answer.
void warn_of_strength_without_end(const loading::Bolt& bolt, const std::string& path,
                                  std::vector<std::string>& warnings) {
  const bool slips = bolt.is_anchored || bolt.grout_strength.has_value();
  if (bolt.yield && slips) return;
  warnings.push_back(fmt::format("{}: {}{}{}; a bolt without a limit holds any load", path,
                                 bolt.yield ? "" : "its bar never yields, without yield",
                                 bolt.yield || slips ? "" : ", and ",
                                 slips ? "" : "its grout never slips, without grout_strength"));
}

}  // namespace

std::vector<std::pair<Vec2, Vec2>> sides_of(const std::optional<std::pair<double, double>>& arc,
                                            const Ring& outline) {
  using Side = std::pair<Vec2, Vec2>;
  const Vec2 centre = centroid(Polygon{outline, {}});
  std::vector<std::pair<double, Side>> sides;  // by their angle from the start
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 a = outline[k], b = outline[(k + 1) % outline.size()];
    if (a == b) continue;
    if (!arc) {
      sides.emplace_back(static_cast<double>(k), Side{a, b});
      continue;
    }
    for (const auto& [from, to] : simulation::within_arc({0.0, 1.0}, a, b, centre, *arc))
      sides.emplace_back(simulation::angle_in_arc(lerp(a, b, 0.5 * (from + to)) - centre, *arc),
                         Side{lerp(a, b, from), lerp(a, b, to)});
  }
  std::ranges::stable_sort(sides, {}, &std::pair<double, Side>::first);
  std::vector<Side> all;
  for (const auto& [angle, side] : sides) all.push_back(side);
  return all;
}

std::vector<std::pair<Vec2, Vec2>> pattern_of(const BoltSpec& spec, const Ring& outline) {
  const std::vector<Part> parts = parts_of(spec, outline);
  double length = 0.0;
  for (const Part& part : parts) length += part.length();
  std::vector<std::pair<Vec2, Vec2>> bolts;
  if (parts.empty()) return bolts;
  std::size_t p = 0;
  double before = 0.0;
  const double near = 1e-9 * length;
  for (const double place : places_of(spec, length)) {
    while (p + 1 < parts.size() && place > before + parts[p].length() + near) before += parts[p++].length();
    const Part& part = parts[p];
    const double along = std::min(place - before, part.length());
    const Vec2 head = lerp(part.from, part.to, along / part.length());
    Vec2 outwards = part.outwards();
    if (along > part.length() - near && p + 1 < parts.size()) outwards = outwards + parts[p + 1].outwards();
    outwards = outwards / norm(outwards);
    bolts.emplace_back(head, head + spec.length * outwards);
  }
  return bolts;
}

std::vector<loading::Bolt> bolts_of(const Scenario& scenario, const std::vector<Ring>& outlines) {
  std::vector<loading::Bolt> bolts;
  for (const BoltSpec& spec : scenario.bolts) {
    if (spec.excavation < 0) {
      bolts.push_back(spec.bolt);
      bolts.back().name = spec.bolt.list;
      continue;
    }
    int number = 0;
    for (const auto& [head, toe] : pattern_of(spec, outlines[static_cast<std::size_t>(spec.excavation)])) {
      loading::Bolt& bolt = bolts.emplace_back(spec.bolt);
      bolt.name = fmt::format("{}.{}", bolt.list, ++number);
      bolt.head = head;
      bolt.toe = toe;
    }
    if (number == 0)
      refuse_bolt(scenario, join_path(join_path("bolt", spec.bolt.list), "arc"),
                  "an arc without a part of the outline",
                  "angles that have some of the outline between them");
  }
  return bolts;
}

void check_bolts(const Scenario& scenario, const simulation::RunSetup& setup,
                 std::vector<std::string>& warnings) {
  std::size_t k = 0;
  for (const BoltSpec& spec : scenario.bolts) {
    const std::string path = join_path("bolt", spec.bolt.list);
    OddBolts odd;
    for (; k < setup.bolts.size() && setup.bolts[k].list == spec.bolt.list; ++k) {
      const loading::Bolt& bolt = setup.bolts[k];
      if (bolt.pretension > 0.0 && bolt.staged < 0)
        refuse_bolt(scenario, join_path(path, "pretension"), "pretension of a bolt that no stage installs",
                    "a stage of kind \"settle\" with the bolt in `install`");
      odd.see(setup, bolt, pieces_of(scenario, setup, k, spec));
    }
    odd.warn(path, warnings);
    warn_of_strength_without_end(spec.bolt, path, warnings);
    if (k > 0 && spec.excavation >= 0 && is_before_its_opening(setup, setup.bolts[k - 1], spec.excavation))
      warnings.push_back(
          fmt::format("{}: is installed before {} is excavated; put it into `install` of that stage, or of a "
                      "later one",
                      path, scenario.excavations[static_cast<std::size_t>(spec.excavation)].path));
  }
}

}  // namespace keyblock::scenario
