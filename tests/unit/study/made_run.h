#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "study/run_result.h"

namespace keyblock::study {

/// A run of one combination with one shaken stage.
inline RunResult made_run(int realization, std::vector<std::string> values, double pga, double fallen,
                          std::string variant = "") {
  RunResult run;
  run.key = "r" + std::to_string(realization) + values[0] + variant;
  run.realization = realization;
  run.values = std::move(values);
  run.variant = std::move(variant);
  StageMeasures quiet, shake;
  quiet.name = "excavated";
  shake.name = "quake";
  shake.kind = record::StageKind::shake;
  shake.pga = pga;
  shake.damage.fallen_area = fallen;
  run.stages = {quiet, shake};
  return run;
}

/// Realizations that lose `gravity` before the shaking and `added` by it, at each of three scales.
inline StudyData shaken(const std::vector<double>& gravity, const std::vector<std::array<double, 3>>& added) {
  StudyData study;
  study.axes = {{"stage.quake.scale", {"1", "2", "3"}}};
  study.levels = {{"light", "fallen_area_m2", 1.0}};
  study.stage = "quake";
  study.since = study.before = "excavated";
  study.at_shaking = true;
  for (std::size_t r = 0; r < gravity.size(); ++r) {
    for (std::size_t s = 0; s < 3; ++s) {
      const double pga = 2.0 + 2.0 * static_cast<double>(s);
      study.runs.push_back(
          made_run(static_cast<int>(r), {study.axes[0].values[s]}, pga, gravity[r] + added[r][s]));
      study.runs.back().stages[0].damage.fallen_area = gravity[r];
      study.runs.back().stages[1].arias = pga * pga;
    }
  }
  return study;
}

}  // namespace keyblock::study
