#include "scenario/joint_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/index.h"

namespace keyblock::scenario {

namespace {

/// Of the length of a map that may be lost without a word: what it shows has been seen. Joints of sets are drawn with gaps, and lose more.
constexpr double most_of_map = 0.05;
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
  return text;
}

void add_joint_warnings(const Scenario& scenario, const BlockModel& model,
                        std::vector<std::string>& warnings) {
  if (scenario.accepted.lost_joints) return;
  for (const cutting::JointShare& share : model.system.joints) {
    if (!is_map(share.joint) || !(share.removed > most_of_map * share.length)) continue;
    const rockmass::TraceSource map{rockmass::TraceSource::Kind::trace_map, share.joint.index};
    warnings.push_back(
        fmt::format("{}: {:.0f} % of its {:.4g} m in the domain end in rock or bound no block; they are not "
                    "in the model, and "
                    "blocks do not break there{}",
                    scenario.trace_maps[at(map.index)].path, 100.0 * share.removed / share.length,
                    share.length, misses_text(NearMisses(model.traces).of(map))));
  }
}

}  // namespace keyblock::scenario
