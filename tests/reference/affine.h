#pragma once

// APIC (Jiang et al. 2015) with the forces of MLS-MPM (Hu et al. 2018), quadratic kernel: steps 1, 3, 4 and 7 of M2 by other means.

#include "tests/reference/transfers.h"

namespace firn::reference {

// sum_i w_ip (x_i - x_p)(x_i - x_p)^T is this times the identity for the quadratic kernel, m2.
inline double affine_inertia(const Grid& grid) { return grid.h * grid.h / 4; }

// Mass, momentum and velocity of nodes; `affine`: C_p, 1/s; `tau`: of stress(), J. Nodes without mass rest; the other arrays are
// left empty.
inline GridState affine_to_grid(const Particles& particles, const std::vector<Matrix3d>& affine, const std::vector<Matrix3d>& tau,
                                const Grid& grid, const Vector3d& gravity, double dt) {
  GridState state;
  state.mass.assign(grid.count(), 0);
  state.momentum.assign(grid.count(), Vector3d::Zero());
  state.velocity = state.momentum;
  for (int p = 0; p < particles.count(); ++p) {
    const Matrix3d a = particles.mass[p] * affine[p] - dt / affine_inertia(grid) * tau[p];
    for (const Neighbor& n : neighbors(grid, Kernel::quadratic, particles.position[p])) {
      state.mass[n.node] += n.weight * particles.mass[p];
      state.momentum[n.node] +=
          n.weight * (particles.mass[p] * particles.velocity[p] + a * (grid.position(n.node) - particles.position[p]));
    }
  }
  for (int i = 0; i < grid.count(); ++i)
    if (state.mass[i] > 0) state.velocity[i] = state.momentum[i] / state.mass[i] + dt * gravity;
  return state;
}

// Sets the particles' velocities and returns C_p, 1/s.
inline std::vector<Matrix3d> grid_to_particles_affine(Particles& particles, const GridState& state, const Grid& grid) {
  std::vector<Matrix3d> affine;
  for (int p = 0; p < particles.count(); ++p) {
    Vector3d v = Vector3d::Zero();
    Matrix3d b = Matrix3d::Zero();
    for (const Neighbor& n : neighbors(grid, Kernel::quadratic, particles.position[p])) {
      v += n.weight * state.velocity[n.node];
      b += n.weight * state.velocity[n.node] * (grid.position(n.node) - particles.position[p]).transpose();
    }
    particles.velocity[p] = v;
    affine.push_back(b / affine_inertia(grid));
  }
  return affine;
}

// x_p x m_p v_p, and what C_p adds: m_p h^2/4 times twice the axial vector of C_p. kg m2/s.
inline Vector3d angular_momentum(const Particles& particles, const std::vector<Matrix3d>& affine, const Grid& grid) {
  Vector3d sum = Vector3d::Zero();
  for (int p = 0; p < particles.count(); ++p) {
    const Matrix3d& c = affine[p];
    const Vector3d turning(c(2, 1) - c(1, 2), c(0, 2) - c(2, 0), c(1, 0) - c(0, 1));
    sum += particles.mass[p] * (particles.position[p].cross(particles.velocity[p]) + affine_inertia(grid) * turning);
  }
  return sum;
}

}  // namespace firn::reference
