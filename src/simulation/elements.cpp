#include "simulation/elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/index.h"
#include "coupling/coupling.h"
#include "simulation/refuse.h"

namespace keyblock::simulation {

using dynamics::Carried;
using dynamics::Model;
using dynamics::State;

namespace {

/// m; infinite where the element goes on through the section.
double spacing_of(const dynamics::Element& element) {
  return element.spacing > 0.0 ? element.spacing : HUGE_VAL;
}

/// Calls of(coupling, carried) for each coupling.
template <typename Of>
void for_carried(const Model& model, const State& state, const Of& of) {
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const dynamics::Coupling& coupling = *model.couplings[k];
    // There is no memory before the first step.
    const std::vector<double> none(k < state.couplings.size() ? 0 : coupling.memory_size(), 0.0);
    of(coupling, coupling.carried(model, state, k < state.couplings.size() ? state.couplings[k] : none));
  }
}

}  // namespace

std::size_t element_count(const Model& model) {
  std::size_t count = 0;
  for (const auto& coupling : model.couplings) count += coupling->elements().size();
  return count;
}

void measure_elements(const Model& model, const State& state, const std::vector<ElementPeak>& peaks,
                      record::Damage& damage) {
  damage.yielded_elements = damage.ruptured_elements = 0;
  for_carried(model, state, [&](const dynamics::Coupling& coupling, const std::vector<Carried>& carried) {
    const std::vector<dynamics::Element> elements = coupling.elements();
    for (std::size_t i = 0; i < carried.size(); ++i)  // without dowels, which go with their bars
      damage.ruptured_elements += carried[i].ruptured && elements[i].may_rupture ? 1 : 0;
  });
  damage.largest_utilization = std::nan("");
  const std::vector<record::ElementDescription> all = element_descriptions(model);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const ElementPeak peak = k < peaks.size() ? peaks[k] : ElementPeak{};
    const bool has_limit = std::isfinite(all[k].limit);
    if (!has_limit && peak.utilization == 0.0) continue;
    const double utilization = has_limit ? peak.force / all[k].limit : peak.utilization;
    damage.yielded_elements += record::reaches_limit(utilization, 1.0) ? 1 : 0;
    damage.largest_utilization = std::fmax(damage.largest_utilization, utilization);
  }
}

std::vector<record::ElementDescription> element_descriptions(const Model& model) {
  std::vector<record::ElementDescription> all;
  for (const auto& coupling : model.couplings) {
    for (const dynamics::Element& e : coupling->elements())
      all.push_back(
          {e.name, e.kind, e.limit, e.from.place, e.to.place, e.from.block, e.to.block, spacing_of(e)});
  }
  return all;
}

bool may_rupture(const Model& model) {
  return std::ranges::any_of(model.couplings, [](const auto& coupling) {
    const std::vector<dynamics::Element> elements = coupling->elements();
    return std::ranges::any_of(elements, &dynamics::Element::may_rupture);
  });
}

std::vector<record::ElementState> element_states(const Model& model, const State& state) {
  std::vector<record::ElementState> all;
  for_carried(model, state, [&](const auto& coupling, const std::vector<Carried>& carried) {
    const std::vector<dynamics::Element> elements = coupling.elements();
    for (std::size_t i = 0; i < carried.size(); ++i) {
      const Carried& c = carried[i];
      all.push_back({.from = c.from,
                     .to = c.to,
                     .force = c.force,
                     .elongation = c.elongation,
                     .yielded = c.yielded,
                     .moment = c.moment,
                     .shear = c.shear,
                     .utilization = std::isfinite(elements[i].limit) ? std::abs(c.force) / elements[i].limit
                                                                     : c.utilization,
                     .present = c.present});
    }
  });
  return all;
}

int element_of(const Model& model, const History& history) {
  const std::vector<record::ElementDescription> all = element_descriptions(model);
  const auto found = std::ranges::find(all, history.element, &record::ElementDescription::name);
  const auto count = std::ranges::count(all, history.element, &record::ElementDescription::name);
  if (count == 1) return static_cast<int>(found - all.begin());
  const std::string key = fmt::format("history.{}.element", history.name);
  if (count > 1)
    refuse(key, fmt::format("\"{}\", which {} elements have", history.element, count),
           "a name that one element has");
  std::string names;
  constexpr std::ptrdiff_t most_names = 20;
  for (auto e = all.begin(); e != all.end(); ++e) {
    if (e - all.begin() == most_names) {
      names += ", …";
      break;
    }
    names += (names.empty() ? "" : ", ") + e->name;
  }
  refuse(key, fmt::format("\"{}\"", history.element),
         all.empty() ? "an element; the model has no springs, supports, boundaries, pressures or water"
                     : "the name of an element: " + names);
}

std::vector<int> keep_peaks(const Model& model, const State& state, int stage,
                            std::vector<ElementPeak>& peaks) {
  std::vector<int> ruptured;
  std::size_t k = 0;
  for_carried(model, state, [&](const dynamics::Coupling& coupling, const std::vector<Carried>& carried) {
    if (peaks.size() < k + carried.size()) peaks.resize(k + carried.size());
    for (std::size_t i = 0; i < carried.size(); ++i, ++k) {
      const Carried& one = carried[i];
      ElementPeak& peak = peaks[k];
      if (std::abs(one.force) > peak.force) {
        peak.force = std::abs(one.force);
        peak.time = state.time;
        peak.stage = stage;
      }
      if (one.utilization > peak.utilization) {
        peak.utilization = one.utilization;
        peak.worst_force = one.force;
        peak.worst_moment = one.moment;
        peak.worst_shear = one.shear;
      }
      if (!one.ruptured || peak.ruptured != 0) continue;
      peak.ruptured = 1;
      if (coupling.elements()[i].may_rupture) ruptured.push_back(static_cast<int>(k));
    }
  });
  return ruptured;
}

std::vector<record::ElementRecord> element_records(const Model& model, const State& state,
                                                   const std::vector<ElementPeak>& peaks,
                                                   const std::vector<record::Stage>& stages) {
  std::vector<record::ElementRecord> records;
  for_carried(model, state, [&](const dynamics::Coupling& coupling, const std::vector<Carried>& carried) {
    const std::vector<dynamics::Element> elements = coupling.elements();
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const Carried& now = carried[i];
      const ElementPeak peak = records.size() < peaks.size() ? peaks[records.size()] : ElementPeak{};
      const double spacing = spacing_of(elements[i]);
      records.push_back(
          {.name = elements[i].name,
           .kind = elements[i].kind,
           .peak_stage = peak.stage < 0 ? "" : stages[static_cast<std::size_t>(peak.stage)].name,
           .present = now.present,
           .from = now.from,
           .to = now.to,
           .force = now.force,
           .elongation = now.elongation,
           .yielded = now.yielded,
           .peak_force = peak.force,
           .peak_time = peak.time,
           .limit = elements[i].limit,
           .spacing = spacing,
           .force_of_one = std::isfinite(spacing) ? now.force * spacing : HUGE_VAL,
           .peak_force_of_one = std::isfinite(spacing) ? peak.force * spacing : HUGE_VAL,
           .ruptured = now.ruptured,
           .moment = now.moment,
           .shear = now.shear});
      if (std::isnan(now.utilization) && peak.utilization == 0.0) continue;
      record::ElementRecord& one = records.back();
      one.worst_utilization = peak.utilization;
      one.worst_force = peak.worst_force;
      one.worst_moment = peak.worst_moment;
      one.worst_shear = peak.worst_shear;
    }
  });
  return records;
}

}  // namespace keyblock::simulation
