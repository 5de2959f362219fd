#pragma once

// H5a [H 3.20-3.28]: what a body displaces is laid on the cells around it, most where it pushes.
// Each body is taken by itself: its overlap is D where it owns the cell and 0 elsewhere. A cell beside several bodies is on the
// contour of the one that pushes most there, the first of equals.

#include "tests/reference/heightfield_direction.h"

namespace firn::reference {

struct ContourCell {
  int z, x;
  Vector2d outward;  // (x, z), unit; zero where the overlap around the cell has no gradient
  double factor;     // s
};

// The values of one body's cells, 0 elsewhere.
inline Cells of_body(const Cells& values, const Owners& owner, int body) { return (owner == body).select(values, 0.0); }

// -Sobel gradient of D at a cell, weights 1 2 1, D = 0 outside the field; not normalised.
inline Vector2d outward_gradient(const Cells& overlap, int z, int x) {
  auto at = [&](int row, int column) { return inside(overlap, row, column) ? overlap(row, column) : 0.0; };
  Vector2d sum(0, 0);
  for (int i = -1; i <= 1; ++i) {
    const double weight = i == 0 ? 2 : 1;
    sum.x() += weight * (at(z + i, x + 1) - at(z + i, x - 1));
    sum.y() += weight * (at(z + 1, x + i) - at(z - 1, x + i));
  }
  return -sum;
}

// K [H 3.20, 3.21] of one body: cells without overlap, of any body, that have some of this body's among their 8 neighbours.
inline std::vector<ContourCell> contour(const Cells& overlap, const Owners& owner, int body, const Vector3d& velocity,
                                        const Direction& direction) {
  const Cells own = of_body(overlap, owner, body);
  std::vector<ContourCell> result;
  for (int z = 0; z < overlap.rows(); ++z) {
    for (int x = 0; x < overlap.cols(); ++x) {
      if (overlap(z, x) > 0) continue;
      bool touches = false;
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dx = -1; dx <= 1; ++dx) touches = touches || (inside(own, z + dz, x + dx) && own(z + dz, x + dx) > 0);
      }
      if (!touches) continue;
      const Vector2d gradient = outward_gradient(own, z, x);
      const Vector2d outward = gradient.norm() > 0 ? Vector2d(gradient.normalized()) : Vector2d(0, 0);
      result.push_back({z, x, outward, direction_factor(velocity, outward, direction)});
    }
  }
  return result;
}

// The contours of all bodies: factor s and body of every cell, 0 and -1 off them.
struct Contours {
  Cells weight;
  Owners owner;
};
inline Contours contours(const Cells& overlap, const Owners& owner, const std::vector<Vector3d>& velocity,
                         const Direction& direction) {
  Contours result{Cells::Zero(overlap.rows(), overlap.cols()), Owners::Constant(overlap.rows(), overlap.cols(), -1)};
  for (int body = 0; body < static_cast<int>(velocity.size()); ++body) {
    for (const ContourCell& cell : contour(overlap, owner, body, velocity[body], direction)) {
      if (result.owner(cell.z, cell.x) >= 0 && cell.factor <= result.weight(cell.z, cell.x)) continue;
      result.weight(cell.z, cell.x) = cell.factor;
      result.owner(cell.z, cell.x) = body;
    }
  }
  return result;
}

// What arrives where. `displaced`: what leaves each cell. Each contour cell of a body gets s_T s / k_T; even shares where k_T = 0;
// snow of a body without a contour stays where it was.
inline Amounts distribute_contour(const Amounts& displaced, const Owners& owner, const Contours& around, int bodies) {
  Amounts arriving = Amounts::none(displaced.mass);
  for (int body = 0; body < bodies; ++body) {
    const Cells own_mass = of_body(displaced.mass, owner, body);
    const Cells own_volume = of_body(displaced.volume, owner, body);
    const auto here = around.owner == body;
    const double k_t = here.select(around.weight, 0.0).sum(), count = static_cast<double>(here.count());
    if (count == 0) {
      arriving.mass += own_mass;
      arriving.volume += own_volume;
      continue;
    }
    const Cells share = k_t > 0 ? Cells(here.select(around.weight / k_t, 0.0)) : Cells(here.cast<double>() / count);
    arriving.mass += share * own_mass.sum();
    arriving.volume += share * own_volume.sum();
  }
  return arriving;
}
inline Amounts distribute_contour(const Amounts& displaced, const Cells& overlap, const Owners& owner,
                                  const std::vector<Vector3d>& velocity, const Direction& direction) {
  return distribute_contour(displaced, owner, contours(overlap, owner, velocity, direction), static_cast<int>(velocity.size()));
}

}  // namespace firn::reference
