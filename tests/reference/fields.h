#pragma once

// Fields for tests of the height-field model.

#include "tests/reference/heightfield_field.h"
#include "tests/reference/random.h"

namespace firn::reference {

inline Field flat_field(int rows, int columns, double h, double snow, double density) {
  return {h, {0, 0}, Cells::Zero(rows, columns), Cells::Constant(rows, columns, snow), Cells::Constant(rows, columns, density)};
}

inline Cells random_cells(Random& random, int rows, int columns, double low, double high) {
  return Cells::NullaryExpr(rows, columns, [&]() { return random.uniform(low, high); });
}

inline Field random_field(Random& random, int rows, int columns, double h) {
  return {h, Vector2d(random.uniform(-5, 5), random.uniform(-5, 5)), random_cells(random, rows, columns, -0.5, 0.5),
          random_cells(random, rows, columns, 0, 1), random_cells(random, rows, columns, 40, 450)};
}

inline Underside nothing_above(int rows, int columns) {
  return {Cells::Constant(rows, columns, std::numeric_limits<double>::infinity()), Owners::Constant(rows, columns, -1)};
}

// A ball over the field: the lower half of its surface. Nearer the ground than other bodies there, it owns the cell.
inline void add_ball(Underside& underside, const Field& field, int body, const Vector3d& center, double radius) {
  for (int z = 0; z < field.rows(); ++z) {
    for (int x = 0; x < field.columns(); ++x) {
      const Vector2d cell = field.origin + field.h * Vector2d(x + 0.5, z + 0.5);
      const double distance_2 = (cell - Vector2d(center.x(), center.z())).squaredNorm();
      if (distance_2 >= radius * radius) continue;
      const double bottom = center.y() - std::sqrt(radius * radius - distance_2);
      if (bottom >= underside.height(z, x)) continue;
      underside.height(z, x) = bottom;
      underside.owner(z, x) = body;
    }
  }
}

}  // namespace firn::reference
