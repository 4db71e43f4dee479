#include "scenario/joint_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/index.h"
#include "rockmass/random_strength.h"
#include "scenario/own_joints.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using rockmass::DrawnPer;
using rockmass::RandomStrength;
using rockmass::strength_count;
using rockmass::StrengthKey;
using rockmass::TraceSource;
using rockmass::TraceStrength;

// A factor of 1 keeps every bit.
void reduce_strength(contact::JointProperties& joint, double factor) {
  if (factor == 1.0) return;
  const double degree = std::numbers::pi / 180.0;
  joint.friction = std::atan(std::tan(joint.friction * degree) / factor) / degree;
  joint.cohesion /= factor;
  joint.tension /= factor;
  if (!joint.residual) return;
  joint.residual->friction = std::atan(std::tan(joint.residual->friction * degree) / factor) / degree;
  joint.residual->cohesion /= factor;
}

contact::JointProperties joint_properties(const JointKeys& own, const JointKeys& standard) {
  const auto pick = [](const std::optional<double>& first, const std::optional<double>& second) {
    return first ? first : second;
  };
  contact::JointProperties joint;
  joint.friction = pick(own.friction, standard.friction).value_or(0.0);
  joint.cohesion = pick(own.cohesion, standard.cohesion).value_or(0.0);
  joint.tension = pick(own.tension, standard.tension).value_or(0.0);
  joint.normal_stiffness = pick(own.normal_stiffness, standard.normal_stiffness);
  const auto shear = pick(own.shear_stiffness, standard.shear_stiffness);
  if (shear && joint.normal_stiffness) joint.stiffness_ratio = *shear / *joint.normal_stiffness;
  if (own.has_residual() || standard.has_residual()) {
    const double friction = pick(own.residual_friction, standard.residual_friction).value_or(joint.friction),
                 cohesion = pick(own.residual_cohesion, standard.residual_cohesion).value_or(0.0);
    // A set may have less strength than what [joints] say is left.
    joint.residual = {std::min(friction, joint.friction), std::min(cohesion, joint.cohesion),
                      pick(own.weakening_slip, standard.weakening_slip).value_or(0.0)};
    if (joint.residual->friction == joint.friction && joint.residual->cohesion == 0.0 &&
        joint.residual->slip == 0.0)
      joint.residual.reset();  // a bond that slips loses its cohesion anyway
  }
  reduce_strength(joint, pick(own.strength_factor, standard.strength_factor).value_or(1.0));
  return joint;
}

cutting::EdgeKind kind_of(TraceSource source) {
  return source.kind == TraceSource::Kind::joint_set ? cutting::EdgeKind::joint_set
                                                     : cutting::EdgeKind::trace_map;
}

std::string_view word_of(DrawnPer per) {
  for (const auto& [word, value] : drawn_per_words)
    if (value == per) return word;
  return "";
}

/// Whole traces by set and map: the first piece of each, and which of them bound blocks.
class TracesOf {
 public:
  TracesOf(const BlockModel& model, TraceSource source) {
    for (const rockmass::Trace& trace : model.traces) {
      if (!(trace.source == source) || trace.number < 0) continue;
      if (at(trace.number) >= first_piece_.size()) first_piece_.resize(at(trace.number) + 1, nullptr);
      if (first_piece_[at(trace.number)] == nullptr) first_piece_[at(trace.number)] = &trace;
    }
    const cutting::EdgeKind kind = kind_of(source);
    for (const cutting::CutBlock& block : model.system.blocks) {
      for (const auto& ring : block.labels) {
        for (const cutting::EdgeLabel label : ring)
          if (label.kind == kind && label.index == source.index && label.trace >= 0)
            in_model_.push_back(label.trace);
      }
    }
    std::ranges::sort(in_model_);
    in_model_.erase(std::unique(in_model_.begin(), in_model_.end()), in_model_.end());
  }

  [[nodiscard]] const std::vector<int>& in_model() const { return in_model_; }
  [[nodiscard]] std::size_t count() const { return first_piece_.size(); }
  [[nodiscard]] const rockmass::Trace& operator[](int number) const { return *first_piece_.at(at(number)); }

 private:
  std::vector<const rockmass::Trace*> first_piece_;
  std::vector<int> in_model_;
};

/// Draws the strengths of one set or map, and adds what differs from trace to trace to the table.
class StrengthDraw {
 public:
  StrengthDraw(const Scenario& scenario, const BlockModel& model, const JointKeys& own, TraceSource source,
               const std::string& name)
      : scenario_(scenario),
        sampling_{scenario.seed, model.realization, scenario.strata},
        keys_(own),
        source_(source),
        label_{kind_of(source), static_cast<std::int16_t>(source.index)},
        name_(name) {
    if (source.kind == TraceSource::Kind::trace_map && at(source.index) < model.map_strengths.size())
      mapped_ = &model.map_strengths[at(source.index)];
    if (mapped_ != nullptr && mapped_->empty()) mapped_ = nullptr;
    for (std::size_t k = 0; k < strength_count; ++k) {
      const auto& random = own.random[k];
      if (random && random->per == DrawnPer::realization) {
        const rockmass::Trace any{{}, {}, source};
        keys_.*strength_members[k] =
            random->quantile(rockmass::uniform_of(sampling_, any, static_cast<StrengthKey>(k), random->per));
      } else if (random) {
        by_trace_ = true;
      }
    }
    by_trace_ = by_trace_ || mapped_ != nullptr;
  }

  /// With the strengths that are drawn once.
  [[nodiscard]] contact::JointProperties of_set() const { return joint_properties(keys_, scenario_.joints); }

  /// Of each trace, its place in table.of_traces; −1 of those that bound no block. Empty where all are alike.
  std::vector<int> of_traces(const BlockModel& model, simulation::JointTable& table) {
    const bool draws =
        by_trace_ || std::ranges::any_of(keys_.random, [](const auto& r) { return r.has_value(); });
    if (!draws) return {};
    const TracesOf traces(model, source_);
    std::vector<int> places(by_trace_ ? traces.count() : 0, -1);
    std::map<TraceStrength, int> known;
    for (const int number : traces.in_model()) {
      const TraceStrength strength = strength_of(traces[number]);
      note(strength);
      if (!by_trace_) continue;
      const auto [place, is_new] = known.try_emplace(strength, static_cast<int>(table.of_traces.size()));
      if (is_new) table.of_traces.push_back({label_, joint_with(strength)});
      places[at(number)] = place->second;
    }
    summarize(table);
    return places;
  }

 private:
  /// What a trace has of its own, or by the draw of its set.
  [[nodiscard]] TraceStrength strength_of(const rockmass::Trace& trace) const {
    TraceStrength strength;
    for (std::size_t k = 0; k < strength_count; ++k) {
      const auto& random = keys_.random[k];
      if (random)
        strength[k] = random->per == DrawnPer::realization
                          ? keys_.*strength_members[k]
                          : random->quantile(rockmass::uniform_of(sampling_, trace,
                                                                  static_cast<StrengthKey>(k), random->per));
      if (mapped_ == nullptr || !(*mapped_).at(at(trace.number))[k]) continue;
      strength[k] = (*mapped_)[at(trace.number)][k];
      if (static_cast<StrengthKey>(k) == StrengthKey::friction)
        strength[k] =
            std::clamp(*strength[k] + keys_.change_of_mapped_friction, 0.0, rockmass::most_friction);
    }
    return strength;
  }

  /// A trace with these strengths.
  [[nodiscard]] contact::JointProperties joint_with(const TraceStrength& strength) const {
    JointKeys keys = keys_;
    for (std::size_t k = 0; k < strength_count; ++k)
      if (strength[k]) keys.*strength_members[k] = strength[k];
    return joint_properties(keys, scenario_.joints);
  }

  [[nodiscard]] double value_of(const TraceStrength& strength, StrengthKey key) const {
    const auto k = static_cast<std::size_t>(key);
    const auto &own = keys_.*strength_members[k], &standard = scenario_.joints.*strength_members[k];
    return strength[k].value_or(own.value_or(standard.value_or(0.0)));
  }

  void note(const TraceStrength& strength) {
    for (std::size_t k = 0; k < strength_count; ++k) {
      if (!strength[k]) continue;
      values_[k].push_back(*strength[k]);
      const auto key = static_cast<StrengthKey>(k);
      const bool is_left = key == StrengthKey::residual_friction || key == StrengthKey::residual_cohesion;
      const StrengthKey peak =
          key == StrengthKey::residual_friction ? StrengthKey::friction : StrengthKey::cohesion;
      if (is_left && *strength[k] > value_of(strength, peak)) ++capped_[k];
    }
  }

  void summarize(simulation::JointTable& table) const {
    for (std::size_t k = 0; k < strength_count; ++k) {
      if (values_[k].empty()) continue;
      const auto& random = keys_.random[k];
      const std::vector<double>& values = values_[k];
      const auto n = static_cast<double>(values.size());
      const auto [least, largest] = std::ranges::minmax(values);
      double sum = 0.0, squares = 0.0;
      for (const double value : values) sum += value - least;
      const double mean = least + sum / n;
      for (const double value : values) squares += (value - mean) * (value - mean);
      table.drawn.push_back({.joint = name_,
                             .key = rockmass::strength_names[k],
                             .unit = rockmass::strength_units[k],
                             .per = std::string(random ? word_of(random->per) : "map"),
                             .traces = static_cast<int>(values.size()),
                             .mean = mean,
                             .std = n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0,
                             .least = least,
                             .largest = largest,
                             .capped = capped_[k]});
    }
  }

  const Scenario& scenario_;
  rockmass::Sampling sampling_;
  JointKeys keys_;  ///< of the set, with the strengths that are drawn once
  TraceSource source_;
  cutting::EdgeLabel label_;  ///< of its edges
  const std::string& name_;
  const std::vector<TraceStrength>* mapped_ = nullptr;  ///< by trace; null: the map has none
  bool by_trace_ = false;
  std::array<std::vector<double>, strength_count> values_;  ///< of the traces in the model
  std::array<int, strength_count> capped_{};
};

}  // namespace

simulation::JointTable joint_table(const Scenario& scenario, const BlockModel& model) {
  simulation::JointTable table;
  table.standard = joint_properties(scenario.joints, {});
  const auto draw = [&](const JointKeys& own, TraceSource source, const std::string& name,
                        std::vector<contact::JointProperties>& joints,
                        std::vector<std::vector<int>>& traces) {
    StrengthDraw drawn(scenario, model, own, source, name);
    joints.push_back(drawn.of_set());
    traces.push_back(drawn.of_traces(model, table));
  };
  const std::vector<OwnJoints> sets = own_joint_sets(scenario), maps = own_trace_maps(scenario);
  for (std::size_t k = 0; k < sets.size(); ++k)
    draw(sets[k].keys, {TraceSource::Kind::joint_set, static_cast<int>(k)}, sets[k].name, table.joint_sets,
         table.joint_set_traces);
  for (std::size_t k = 0; k < maps.size(); ++k)
    draw(maps[k].keys, {TraceSource::Kind::trace_map, static_cast<int>(k)}, maps[k].name, table.trace_maps,
         table.trace_map_traces);
  table.frame = table.standard;
  table.frame.friction = scenario.domain ? scenario.domain->frame_friction : 0.0;
  table.frame.cohesion = table.frame.tension = 0.0;
  table.frame.residual.reset();
  return table;
}

std::vector<std::pair<std::string, std::string>> strength_facts(const simulation::JointTable& joints) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (const record::DrawnStrength& drawn : joints.drawn) {
    const bool is_angle = drawn.unit == "°";
    const auto text = [&](double value) {
      return is_angle ? fmt::format("{:.4g}°", value) : fmt::format("{:.4g} Pa", value);
    };
    std::string value = text(drawn.mean);
    if (drawn.per != "realization" && drawn.traces > 1)
      value += fmt::format(" on the mean of {} traces, {} to {}", drawn.traces, text(drawn.least),
                           text(drawn.largest));
    facts.emplace_back(
        fmt::format("{} of “{}”, {}", drawn.key, drawn.joint, drawn.per == "map" ? "by its map" : "drawn"),
        std::move(value));
  }
  return facts;
}

namespace {

template <class Holds>
bool any_random(const Scenario& scenario, const Holds& holds) {
  const auto has = [&](const auto& spec) {
    return std::ranges::any_of(spec.joints.random,
                               [&](const auto& random) { return random && holds(*random); });
  };
  return std::ranges::any_of(scenario.joint_sets, has) || std::ranges::any_of(scenario.trace_maps, has);
}

}  // namespace

bool has_random_strengths(const Scenario& scenario) {
  return any_random(scenario, [](const RandomStrength&) { return true; });
}

bool has_strengths_of_realizations(const Scenario& scenario) {
  return any_random(scenario,
                    [](const RandomStrength& random) { return random.per == DrawnPer::realization; });
}

}  // namespace keyblock::scenario
