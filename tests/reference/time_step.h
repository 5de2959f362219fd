#pragma once

// The length of a step: nothing goes farther than a share of a cell, neither particles nor the pressure waves in them.

#include "tests/reference/material.h"

namespace firn::reference {

// Of pressure waves in hardened snow, m/s: sqrt((lambda + 2 mu) / rho).
inline double wave_speed(const Material& m, double plastic_det) {
  const Lame l = hardened(m, plastic_det);
  return std::sqrt((l.lambda + 2 * l.mu) / m.density);
}

// The largest |v_p| + c_p, m/s; 0 of none.
inline double fastest(const Particles& particles, const std::vector<Material>& materials) {
  double speed = 0;
  for (int p = 0; p < particles.count(); ++p)
    speed =
        std::max(speed, particles.velocity[p].norm() + wave_speed(materials.at(particles.material[p]), particles.plastic_det[p]));
  return speed;
}

// In how few equal steps `left`, s, is done, none of which is longer than cfl h / speed.
inline double steps_until(double left, double speed, double cfl, double cell) {
  return std::max(1.0, std::ceil(left * speed / (cfl * cell)));
}

}  // namespace firn::reference
