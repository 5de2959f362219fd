#pragma once

// Steps 1 to 7 of M2: between particles and grid, and on the grid.

#include "tests/reference/collision.h"
#include "tests/reference/interpolation.h"
#include "tests/reference/particles.h"

namespace firn::reference {

// All arrays have one entry per node, numbered by Grid::index.
struct GridState {
  std::vector<double> mass;               // m_i, kg
  std::vector<Vector3d> momentum;         // (m v)_i, kg m/s
  std::vector<Vector3d> force;            // f_i, N
  std::vector<Vector3d> velocity_before;  // v_i, before forces and collisions, m/s; zero where there is no mass
  std::vector<Vector3d> velocity;         // v_i* and, after the collision, v_i^{n+1}, m/s; zero where there is no mass
};

// Step 1. Gives mass and momentum; the other arrays are left empty.
inline GridState particles_to_grid(const Particles& particles, const Grid& grid, Kernel kernel) {
  GridState state;
  state.mass.assign(grid.count(), 0);
  state.momentum.assign(grid.count(), Vector3d::Zero());
  for (int p = 0; p < particles.count(); ++p) {
    for (const Neighbor& n : neighbors(grid, kernel, particles.position[p])) {
      state.mass[n.node] += particles.mass[p] * n.weight;
      state.momentum[n.node] += particles.mass[p] * n.weight * particles.velocity[p];
    }
  }
  return state;
}

// Step 2, once. Returns rho_p0, kg/m3, and sets the particles' volumes.
inline std::vector<double> initial_density(Particles& particles, const GridState& state, const Grid& grid, Kernel kernel) {
  std::vector<double> density;
  for (int p = 0; p < particles.count(); ++p) {
    double mass = 0;
    for (const Neighbor& n : neighbors(grid, kernel, particles.position[p])) mass += state.mass[n.node] * n.weight;
    density.push_back(mass / (grid.h * grid.h * grid.h));
    particles.volume[p] = particles.mass[p] / density.back();
  }
  return density;
}

// Step 3 [M 26]: f_i = - sum_p tau_p grad w_ip, from the stresses of stress().
inline std::vector<Vector3d> grid_forces(const Particles& particles, const std::vector<Matrix3d>& tau, const Grid& grid,
                                         Kernel kernel) {
  std::vector<Vector3d> force(grid.count(), Vector3d::Zero());
  for (int p = 0; p < particles.count(); ++p) {
    for (const Neighbor& n : neighbors(grid, kernel, particles.position[p])) force[n.node] -= tau[p] * n.gradient;
  }
  return force;
}

// Step 4, from mass, momentum and force.
inline void grid_update(GridState& state, const Vector3d& gravity, double dt) {
  state.velocity_before.assign(state.mass.size(), Vector3d::Zero());
  state.velocity = state.velocity_before;
  for (std::size_t i = 0; i < state.mass.size(); ++i) {
    if (state.mass[i] <= 0) continue;
    state.velocity_before[i] = state.momentum[i] / state.mass[i];
    state.velocity[i] = state.velocity_before[i] + dt * (state.force[i] / state.mass[i] + gravity);
  }
}

// Step 5. Nodes without mass stay at rest.
inline void grid_collide(GridState& state, const Grid& grid, const std::vector<Collider>& colliders) {
  for (int i = 0; i < grid.count(); ++i) {
    if (state.mass[i] > 0) state.velocity[i] = collide(state.velocity[i], grid.position(i), colliders);
  }
}

// Step 7. Sets the particles' velocities, `alpha` of them from FLIP, and returns grad v_p, 1/s: row = component of v, column =
// axis.
inline std::vector<Matrix3d> grid_to_particles(Particles& particles, const GridState& state, const Grid& grid, Kernel kernel,
                                               double alpha) {
  std::vector<Matrix3d> gradient;
  for (int p = 0; p < particles.count(); ++p) {
    Vector3d pic = Vector3d::Zero(), change = Vector3d::Zero();
    Matrix3d slope = Matrix3d::Zero();
    for (const Neighbor& n : neighbors(grid, kernel, particles.position[p])) {
      pic += n.weight * state.velocity[n.node];
      change += n.weight * (state.velocity[n.node] - state.velocity_before[n.node]);
      slope += state.velocity[n.node] * n.gradient.transpose();
    }
    particles.velocity[p] = (1 - alpha) * pic + alpha * (particles.velocity[p] + change);
    gradient.push_back(slope);
  }
  return gradient;
}

}  // namespace firn::reference
