#pragma once

// Shipped height-field pipelines on made-up scenes, and sums over their fields.

#include <fmt/format.h>

#include <numeric>

#include "tests/stages/simulation.h"

namespace firn::test {

inline const char* const field_pipelines[] = {"heightfield_contour", "heightfield_distance"};

struct FieldState {
  int rows = 0, columns = 0;
  double h = 0;
  std::vector<float> ground, depth, density;

  [[nodiscard]] std::size_t at(int z, int x) const { return static_cast<std::size_t>(z * columns + x); }
  [[nodiscard]] double height(int z, int x) const {
    return static_cast<double>(ground[at(z, x)]) + static_cast<double>(depth[at(z, x)]);
  }
  [[nodiscard]] double mass() const {
    double sum = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) sum += static_cast<double>(depth[i]) * static_cast<double>(density[i]);
    return sum * h * h;
  }
};

inline FieldState field_state(const Simulation& simulation) {
  const scene::Field& field = *simulation.loaded.problem->scene.field;
  return {field.cells_z,
          field.cells_x,
          field.size.x() / field.cells_x,
          simulation.floats("ground"),
          simulation.floats("depth"),
          simulation.floats("density")};
}

// The steepest way down from snow to a neighbour that no body covers, over the limit; m.
inline double worst_excess(const FieldState& f, double slope, const std::vector<float>& underside) {
  double worst = 0;
  for (int z = 0; z < f.rows; ++z)
    for (int x = 0; x < f.columns; ++x) {
      if (f.depth[f.at(z, x)] <= 0) continue;
      for (int dz = -1; dz <= 1; ++dz)
        for (int dx = -1; dx <= 1; ++dx) {
          const int to_z = z + dz, to_x = x + dx;
          if ((dz == 0 && dx == 0) || to_z < 0 || to_x < 0 || to_z >= f.rows || to_x >= f.columns) continue;
          if (f.height(z, x) >= static_cast<double>(underside[f.at(to_z, to_x)])) continue;
          worst = std::max(worst, f.height(z, x) - f.height(to_z, to_x) - slope * f.h * std::hypot(dz, dx));
        }
    }
  return worst;
}

}  // namespace firn::test
