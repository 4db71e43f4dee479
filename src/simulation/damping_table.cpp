#include "simulation/damping_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/damping.h"

namespace keyblock::simulation {

namespace {

/// Share of critical at a frequency, Hz, that rock_damping makes in a block of mean area; see dynamics::BlockTerms.
double of_blocks(const RunSetup& setup, double frequency) {
  double area = 0.0, slowness = 0.0;
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    const block::Material& rock = setup.properties[b].material;
    const double of_block = keyblock::area(setup.system.blocks[b].polygon);
    area += of_block;
    slowness += of_block * std::sqrt(rock.density / rock.young);
  }
  if (area <= 0.0) return 0.0;
  const double size = std::sqrt(area / static_cast<double>(setup.properties.size()));
  return setup.solver.rock_damping * 2.0 * frequency * size * slowness / area;
}

}  // namespace

std::vector<record::DampingRow> damping_table(const RunSetup& setup) {
  const bool is_dynamic = std::any_of(setup.stages.begin(), setup.stages.end(), [](const record::Stage& s) {
    return s.kind != record::StageKind::settle;
  });
  std::vector<record::DampingRow> rows;
  if (!is_dynamic) return rows;
  const auto rule = dynamics::Integrator::of(setup.solver);
  for (const double frequency : {1.0, 3.0, 10.0, 30.0}) {
    const double rock =
        setup.solver.damping ? setup.solver.damping->ratio_at(frequency) : of_blocks(setup, frequency);
    const double in_waves =
        setup.solver.damping ? std::numbers::pi * frequency * setup.solver.damping->stiffness_time() : rock;
    rows.push_back(
        {frequency, rock, dynamics::numerical_damping(rule, setup.time_step, frequency), in_waves});
  }
  return rows;
}

}  // namespace keyblock::simulation
