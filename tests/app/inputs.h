#pragma once

// A small valid pipeline and scene, to be spoilt, and command lines for them.

#include <string>

#include "tests/app/child.h"

namespace firn::test {

inline const std::string small_pipeline = R"(firn: 1
name: small
scene: scene.yaml
parameters:
  kernel: quadratic
  accumulate: fixed
setup:
  - mpm.seed
  - bodies.place
  - mpm.clear_grid: {accumulate: "${accumulate}"}
  - mpm.particles_to_grid: {kernel: "${kernel}", accumulate: "${accumulate}"}
  - mpm.grid_update: {accumulate: "${accumulate}"}
  - mpm.initial_density: {kernel: "${kernel}"}
step:
  - mpm.time_step
  - mpm.clear_grid: {accumulate: "${accumulate}"}
  - mpm.particles_to_grid: {kernel: "${kernel}", accumulate: "${accumulate}"}
  - mpm.stress: {accumulate: "${accumulate}"}
  - mpm.grid_forces: {kernel: "${kernel}", accumulate: "${accumulate}"}
  - mpm.grid_update: {accumulate: "${accumulate}"}
  - mpm.grid_collide
  - mpm.grid_to_particles: {kernel: "${kernel}", flip: 0.95}
  - mpm.deform
  - mpm.particle_collide
  - mpm.advect
  - bodies.integrate
)";

// 17 x 19 x 21 nodes.
inline const std::string small_scene = R"(firn: 1
name: small
seed: 3
time: {dt: 2.0e-4, fps: 1000, end: 0.01}
gravity: [0, -9.81, 0]
domain: {min: [0, 0, 0], max: [0.8, 0.9, 1.0], cell: 0.05}
materials:
  ball: {preset: packed, young: 1.0e5, density: 400}
snow:
  - {sphere: {center: [0.4, 0.45, 0.5], radius: 0.12}, material: ball, velocity: [0, -3, 0], per_cell: 4}
bodies:
  - {plane: {point: [0, 0.3, 0], normal: [0, 1, 0]}, name: ground, friction: 0.5}
  - {sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5], name: stone, mass: 2}
)";

// 48 x 48 cells; a ball that moves as told, and a box that falls.
inline const std::string small_field = R"(firn: 1
name: small_field
time: {dt: 2.0e-3, fps: 100, end: 0.2}
materials: {snow: {preset: new_snow}}
field: {size: [3, 3], cells: [48, 48], ground: 0, depth: 0.4, density: 100, material: snow}
bodies:
  - {sphere: {radius: 0.4}, position: [1.0, 0.6, 1.5], velocity: [2, -0.5, 0], friction: 0.2}
  - {box: {size: [0.4, 0.4, 0.4]}, position: [2, 0.7, 1], mass: 30}
)";

// `run PIPELINE` of a pipeline that comes with Firn, on a scene file, into `output`, without pictures.
inline Words run_without_pictures(const std::string& pipeline, const std::string& scene, const std::string& output,
                                  const Words& more = {}) {
  Words words{"run", pipeline, "--scene", scene, "--out", output};
  const std::string drawing = pipeline.starts_with("heightfield") ? "render.heightfield" : "render.particles";
  for (const std::string& stage : {std::string("render.shadow_map"), std::string("render.background"), drawing,
                                   std::string("io.frames"), std::string("io.video")})
    words.insert(words.end(), {"--disable", stage});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace firn::test
