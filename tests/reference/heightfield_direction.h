#pragma once

// H4 [H 3.12-3.19]: how strongly a body that moves with v pushes snow in a direction.

#include <cmath>

#include "tests/reference/heightfield_field.h"

namespace firn::reference {

enum class FactorRule { thesis, appendix };

struct Direction {
  FactorRule rule = FactorRule::thesis;
  double k = 8;  // >= 1: how little a body that goes straight down pushes to the sides
};

// s. `outward`: unit vector (x, z), or zero where there is no direction.
inline double direction_factor(const Vector3d& velocity, const Vector2d& outward, const Direction& direction) {
  const double speed = velocity.norm();
  const Vector3d v = speed > 0 ? Vector3d(velocity / speed) : Vector3d(0, 0, 0);
  const Vector2d horizontal(v.x(), v.z());
  const double d = horizontal.squaredNorm();
  // r = 1 - d, as the square of v^_y: rounding can then make it neither negative nor, for level motion, other than zero.
  const double r = speed > 0 ? v.y() * v.y() : 1;
  const double along = std::max(0.0, horizontal.dot(outward));
  if (direction.rule == FactorRule::appendix) return d * along + r / direction.k;
  return (d > 0 ? along / std::sqrt(d) : 0) + r / direction.k;
}

// 1/s for a step to each side, infinite where s = 0. Left is -x, right +x, down -z, up +z.
struct StepCosts {
  double left, right, down, up;
};

inline StepCosts step_costs(const Vector3d& velocity, const Direction& direction) {
  auto cost = [&](double x, double z) {
    const double s = direction_factor(velocity, {x, z}, direction);
    return s > 0 ? 1 / s : std::numeric_limits<double>::infinity();
  };
  return {cost(-1, 0), cost(1, 0), cost(0, -1), cost(0, 1)};
}

}  // namespace firn::reference
