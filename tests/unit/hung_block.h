#pragma once
#include "scene.h"

namespace keyblock::simulation {

inline constexpr double hanger_stiffness = 1e7;  // N/m per m

inline loading::Spring hanger(double from, double to, int staged) {
  loading::Spring spring;
  spring.from = {0.5, from};
  spring.to = {0.5, to};
  spring.stiffness = hanger_stiffness;
  spring.staged = staged;
  return spring;
}

/// A block that hangs from a roof by a spring; another one and ballast, which are installed and taken away.
inline Scene hung_block() {
  Scene scene(1e11, 30.0);
  scene.rectangle({0.0, 3.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.rectangle({0.3, 1.0}, 0.4, 0.5);
  scene.setup.gravity = {0.0, -g};
  scene.setup.system.blocks[2].excavations = {0};
  scene.setup.excavations.push_back({"ballast", {{0.2, 1.0}, {0.8, 1.0}, {0.8, 1.6}, {0.2, 1.6}}});
  scene.setup.springs = {hanger(3.0, 0.9, -1), hanger(3.0, 0.8, 0)};
  scene.setup.staged_supports = {"second"};
  scene.setup.time_step = 0.002;
  record::Stage in_place = stage("hang", record::StageKind::settle),
                unload = stage("unload", record::StageKind::settle);
  in_place.tolerance = unload.tolerance = 1e-9;
  record::Stage support = in_place;
  support.name = "support";
  support.install = {"second"};
  unload.excavate = {0};
  scene.setup.stages = {in_place, support, unload, stage("wait", record::StageKind::rest, 0.1)};
  return scene;
}

}  // namespace keyblock::simulation
