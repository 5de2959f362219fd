#pragma once

// Random fields with random balls over them, the same for a stage and its reference: every number is exact in single precision.

#include "tests/catch.h"
#include "tests/reference/fields.h"
#include "tests/reference/heightfield.h"
#include "tests/stages/harness.h"
#include "tests/stages/random_snow.h"

namespace firn::test {

using reference::Cells;
using reference::Owners;

struct RandomField {
  RandomField(std::uint64_t seed, int rows, int columns, int balls);

  reference::Random random;
  reference::Field field;
  std::vector<Vector3d> velocity;  // of the balls
  reference::Underside underside;
  Cells overlap;
  double min_density = 30, max_density = 500, slope = 0.6;

  [[nodiscard]] graph::Environment environment() const;
  // ground, depth, density, underside, owner, overlap, body_velocity
  [[nodiscard]] Arrays arrays(std::initializer_list<const char*> ports) const;
};

Cells single(const Cells& cells);
std::vector<float> flat(const Cells& cells);
std::vector<std::int32_t> flat(const Owners& owners);

// Domains cells, tiles, bodies, facets, key_frames and the constants of the height field.
graph::Environment field_environment(int rows, int columns, double cell, std::uint64_t bodies,
                                     const reference::Vector2d& origin = {0, 0});

}  // namespace firn::test
