#include "scenario/joint_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/index.h"
#include "cutting/interfaces.h"
#include "rockmass/intensity.h"
#include "rockmass/section.h"
#include "scenario/magnitudes.h"
#include "scenario/sections.h"

namespace keyblock::scenario {

namespace {

/// Of the length of a map that may be lost without a word: what it shows has been seen. Joints of sets are drawn with gaps, and lose
/// more.
constexpr double most_of_map = 0.05, most_of_set = 0.3;
/// Of the length of a trace: an end that misses another trace by less was probably meant to meet it. What is nearer than `met` meets it.
constexpr double near_miss = 0.05, met = 1e-6;
constexpr std::size_t most_named = 3;

bool is_map(cutting::EdgeLabel label) {
  return label.kind == cutting::EdgeKind::trace_map;
}

const std::string& name_of(const Scenario& scenario, cutting::EdgeLabel label) {
  const auto k = static_cast<std::size_t>(label.index);
  return is_map(label) ? scenario.trace_maps[k].name : scenario.joint_sets[k].set.name;
}

double distance(Vec2 p, const rockmass::Trace& trace) {
  const Vec2 along = trace.b - trace.a;
  const double s = std::clamp(dot(p - trace.a, along) / squared_norm(along), 0.0, 1.0);
  return norm(p - trace.a - s * along);
}

bool cross_each_other(const rockmass::Trace& one, const rockmass::Trace& other) {
  const auto parts = [](const rockmass::Trace& line, const rockmass::Trace& of) {
    const Vec2 along = line.b - line.a;
    return cross(along, of.a - line.a) * cross(along, of.b - line.a) <= 0.0;
  };
  return parts(one, other) && parts(other, one);
}

/// An end of a mapped trace just short of another trace.
struct Miss {
  Vec2 end;
  double gap = 0.0;  ///< m
};

/// Pieces of traces by the number of their trace.
class NearMisses {
 public:
  explicit NearMisses(const std::vector<rockmass::Trace>& pieces)
      : pieces_(pieces), number_(rockmass::trace_numbers(pieces)) {
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      length_.resize(std::max(length_.size(), at(number_[k]) + 1), 0.0);
      length_[at(number_[k])] += norm(pieces[k].b - pieces[k].a);
    }
  }

  /// The smallest first.
  [[nodiscard]] std::vector<Miss> of(rockmass::TraceSource map) const {
    std::vector<Miss> misses;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (!(pieces_[k].source == map)) continue;
      const bool is_first = k == 0 || number_[k - 1] != number_[k],
                 is_last = k + 1 == pieces_.size() || number_[k + 1] != number_[k];
      if (is_first) add(number_[k], pieces_[k].a, misses);
      if (is_last) add(number_[k], pieces_[k].b, misses);
    }
    std::ranges::sort(misses, {}, &Miss::gap);
    return misses;
  }

 private:
  void add(int trace, Vec2 end, std::vector<Miss>& misses) const {
    std::optional<std::size_t> nearest;
    double gap = near_miss * length_[at(trace)];
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const double away = distance(end, pieces_[k]);
      if (number_[k] == trace || !(away < gap)) continue;
      gap = away;
      nearest = k;
    }
    if (nearest && gap > met * length_[at(trace)] && !meet(trace, number_[*nearest]))
      misses.push_back({end, gap});
  }

  /// What meets the other trace somewhere ends beyond it.
  [[nodiscard]] bool meet(int one, int other) const {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (number_[i] != one) continue;
      for (std::size_t k = 0; k < pieces_.size(); ++k)
        if (number_[k] == other && cross_each_other(pieces_[i], pieces_[k])) return true;
    }
    return false;
  }

  const std::vector<rockmass::Trace>& pieces_;
  std::vector<int> number_;
  std::vector<double> length_;  ///< m, per trace
};

/// "; an end at (3.00, 4.00) is 0.45 m short of another trace: [cutting] snapping = 0.5 joins them".
std::string misses_text(const std::vector<Miss>& misses) {
  if (misses.empty()) return {};
  std::string text;
  const std::size_t named = std::min(misses.size(), most_named);
  for (std::size_t k = 0; k < named; ++k)
    text += fmt::format("; the end at ({:.2f}, {:.2f}) is {:.2g} m short of another trace", misses[k].end.x,
                        misses[k].end.y, misses[k].gap);
  if (misses.size() > named) text += fmt::format("; {} more such ends", misses.size() - named);
  return text + fmt::format(": [cutting] snapping = {:.2g} would join them", 1.1 * misses[named - 1].gap);
}

}  // namespace

std::string joints_in_model(const Scenario& scenario, const cutting::BlockSystem& system) {
  std::string text;
  for (const cutting::JointShare& share : system.joints) {
    if (!(share.length > 0.0)) continue;
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", name_of(scenario, share.joint),
                        100.0 * (1.0 - share.removed / share.length));
  }
  for (const cutting::JointShare& share : system.joints) {
    if (share.bridged > 0.0)
      text += fmt::format(", {:.4g} m of rock bridges on {}", share.bridged, name_of(scenario, share.joint));
  }
  return text;
}

namespace {

void warn_of_map(const Scenario& scenario, const BlockModel& model, const cutting::JointShare& share,
                 std::vector<std::string>& warnings) {
  const rockmass::TraceSource map{rockmass::TraceSource::Kind::trace_map, share.joint.index};
  warnings.push_back(
      fmt::format("{}: {:.0f} % of its {:.4g} m in the domain end in rock or bound no block; they are not in "
                  "the model, and "
                  "blocks do not break there{}",
                  scenario.trace_maps[at(map.index)].path, 100.0 * share.removed / share.length, share.length,
                  misses_text(NearMisses(model.traces).of(map))));
}

void warn_of_lost_joints(const Scenario& scenario, const BlockModel& model,
                         std::vector<std::string>& warnings) {
  std::string sets;
  for (const cutting::JointShare& share : model.system.joints) {
    const double most = is_map(share.joint) ? most_of_map : most_of_set;
    if (!(share.removed > most * share.length)) continue;
    if (is_map(share.joint)) {
      warn_of_map(scenario, model, share, warnings);
    } else {
      sets += fmt::format("{}{:.0f} % of '{}'", sets.empty() ? "" : ", ",
                          100.0 * share.removed / share.length, name_of(scenario, share.joint));
    }
  }
  if (!sets.empty())
    warnings.push_back(
        fmt::format("joint_set: {} end in rock or bound no block, by their length in the domain; they are "
                    "not in the model, blocks "
                    "do not break there, and the rock is stronger than its joints make it",
                    sets));
}

/// A slip by which a map comes to lie beside the domain.
struct MapSlip {
  const char* what;
  double factor;
  bool swaps;
};
constexpr MapSlip map_slips[] = {{"with x and y exchanged", 1.0, true},
                                 {"taken as mm", 1e-3, false},
                                 {"taken as cm", 1e-2, false},
                                 {"taken as km", 1e3, false}};

/// A map as a slip would have it.
struct SlippedMap {
  double share_inside = 1.0;
  Vec2 size;
};

SlippedMap slipped(const std::vector<rockmass::Trace>& traces, const Box& domain, const MapSlip& slip) {
  double inside = 0.0, all = 0.0;
  Box box;
  for (rockmass::Trace trace : traces) {
    for (Vec2* p : {&trace.a, &trace.b}) {
      if (slip.swaps) std::swap(p->x, p->y);
      *p = slip.factor * *p;
      box.add(*p);
    }
    inside += rockmass::length_inside(trace, domain);
    all += norm(trace.b - trace.a);
  }
  if (!(all > 0.0)) return {};
  return {inside / all, box.size()};
}

/// What lies beside the domain, and would lie in it and fill a good part of it by a usual slip.
void warn_of_maps_outside(const Scenario& scenario, const BlockModel& model,
                          std::vector<std::string>& warnings) {
  constexpr double enough = 0.9, little = 0.5, better = 0.2, part = 0.3;
  const Box domain = scenario.domain->box();
  const double side = std::max(domain.size().x, domain.size().y);
  for (std::size_t k = 0; k < scenario.trace_maps.size(); ++k) {
    const rockmass::TraceSource source{rockmass::TraceSource::Kind::trace_map, static_cast<int>(k)};
    std::vector<rockmass::Trace> traces;
    for (const rockmass::Trace& trace : model.traces)
      if (trace.source == source) traces.push_back(trace);
    const double inside = slipped(traces, domain, {"", 1.0, false}).share_inside;
    const auto* slip = std::ranges::find_if(map_slips, [&](const MapSlip& s) {
      const SlippedMap then = slipped(traces, domain, s);
      return then.share_inside >= enough && then.share_inside > inside + better &&
             std::max(then.size.x, then.size.y) >= part * side && (s.swaps || inside < little);
    });
    if (slip == std::end(map_slips)) continue;
    warnings.push_back(
        fmt::format("{}: {:.0f} % of its length lies outside the domain; {}, {:.0f} % would lie inside",
                    scenario.trace_maps[k].path, 100.0 * (1.0 - inside), slip->what,
                    100.0 * slipped(traces, domain, *slip).share_inside));
  }
}

/// 1/m, length of traces per area that the sets have in a section of an azimuth.
double intensity(const Scenario& scenario, double azimuth) {
  double sum = 0.0;
  for (const JointSetSpec& spec : scenario.joint_sets) {
    const rockmass::JointSet& set = spec.set;
    sum += 1.0 / (set.spacing.mean * rockmass::trace_spacing_factor(set.dip, set.dip_direction, azimuth));
  }
  return sum;
}

/// Blocks as large as the opening, and joints that meet the section across far oftener.
void warn_of_large_blocks(const Scenario& scenario, const BlockModel& model,
                          std::vector<std::string>& warnings) {
  constexpr double large = 0.7, much = 1.5, quarter = 90.0, turn = 360.0;
  if (!scenario.section_azimuth || scenario.joint_sets.empty() || scenario.excavations.empty()) return;
  double width = HUGE_VAL;
  for (const ExcavationSpec& spec : scenario.excavations)
    width = std::min(width, bounds(Polygon{excavation_outline(spec), {}}).size().x);
  const Vec2 extent = scenario.domain->box().size();
  const double blocks = static_cast<double>(model.system.blocks.size()),
               size = std::sqrt(extent.x * extent.y / std::max(blocks, 1.0)),
               azimuth = *scenario.section_azimuth;
  if (size < large * width) return;
  const double across = std::fmod(azimuth + quarter, turn),
               closer = intensity(scenario, across) / intensity(scenario, azimuth);
  if (!(closer > much)) return;
  warnings.push_back(fmt::format(
      "section.azimuth = {}{}: {} blocks of some {:.2g} m beside an opening of {:.2g} m; it is the direction "
      "of +x, "
      "across a tunnel; with {} the joints would lie {:.2g} times as close: was it that of the axis?",
      azimuth, place_text(scenario, "section.azimuth"), model.system.blocks.size(), size, width, across,
      closer));
}

/// Interfaces of blocks that do not touch, until they do.
void warn_of_interfaces(const Scenario& scenario, const BlockModel& model,
                        std::vector<std::string>& warnings) {
  const std::vector<cutting::InterfaceFace> faces = cutting::interface_faces(model.system);
  for (std::size_t k = 0; k < scenario.interfaces.size(); ++k) {
    const InterfaceSpec& spec = scenario.interfaces[k];
    if (std::ranges::find(faces, model.system.interfaces[k].joint, &cutting::InterfaceFace::joint) !=
        faces.end())
      continue;
    warnings.push_back(fmt::format("{}{}: no edge of '{}' lies on one of '{}'", spec.path,
                                   place_text(scenario, spec.path), spec.between.first, spec.between.second));
  }
}

void warn_of_bridges(const Scenario& scenario, std::vector<std::string>& warnings) {
  if (!scenario.rock_bridge) return;
  if (scenario.cutting.bridges_dead_ends ||
      std::ranges::any_of(scenario.joint_sets, [](const JointSetSpec& spec) { return spec.gap_bonds; }))
    return;
  warnings.push_back(
      fmt::format("{}{}: no joint has bridges; [cutting] dead_ends = \"bridge\" and gap_bonds of a joint set "
                  "make them",
                  scenario.rock_bridge->path, place_text(scenario, scenario.rock_bridge->path)));
}

}  // namespace

void add_joint_warnings(const Scenario& scenario, const BlockModel& model,
                        std::vector<std::string>& warnings) {
  if (!scenario.accepted.lost_joints) warn_of_lost_joints(scenario, model, warnings);
  warn_of_maps_outside(scenario, model, warnings);
  warn_of_large_blocks(scenario, model, warnings);
}

void add_own_joint_warnings(const Scenario& scenario, const BlockModel& model,
                            std::vector<std::string>& warnings) {
  warn_of_interfaces(scenario, model, warnings);
  warn_of_bridges(scenario, warnings);
}

}  // namespace keyblock::scenario
