#pragma once

// One explicit step in the order of M2 [M 3.4, fig. 9].

#include "tests/reference/material.h"
#include "tests/reference/transfers.h"

namespace firn::reference {

struct StepSettings {
  double dt = 1e-4;               // s
  Vector3d gravity{0, -9.81, 0};  // m/s2
  double alpha = 0.95;            // share of FLIP
  Kernel kernel = Kernel::cubic;
  bool measure_volume = false;  // step 2: take the volumes from the grid; the first step only
};

// Step 10.
inline void advect(Particles& particles, std::vector<Collider>& colliders, double dt) {
  for (int p = 0; p < particles.count(); ++p) particles.position[p] += dt * particles.velocity[p];
  advance(colliders, dt);
}

// Steps 0 to 10. Returns the grid as it was used. Throws std::out_of_range for a particle at the grid's edge.
inline GridState step(Particles& particles, const Grid& grid, const std::vector<Material>& materials,
                      std::vector<Collider>& colliders, const StepSettings& settings) {
  GridState state = particles_to_grid(particles, grid, settings.kernel);
  if (settings.measure_volume) initial_density(particles, state, grid, settings.kernel);
  state.force = grid_forces(particles, stress(particles, materials), grid, settings.kernel);
  grid_update(state, settings.gravity, settings.dt);
  grid_collide(state, grid, colliders);
  const std::vector<Matrix3d> gradient = grid_to_particles(particles, state, grid, settings.kernel, settings.alpha);
  deform(particles, gradient, materials, settings.dt);
  particle_collide(particles, colliders);
  advect(particles, colliders, settings.dt);
  return state;
}

}  // namespace firn::reference
