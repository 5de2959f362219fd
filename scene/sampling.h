#pragma once

// Shapes filled with particles.

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace firn::scene {

// Particles in creation order: snow by snow as in the scene file, within one by ascending cell (z, then y, then x).
struct Particles {
  std::vector<Vector3d> position;  // m
  std::vector<Vector3d> velocity;  // m/s
  std::vector<double> mass;        // kg
  std::vector<double> volume;      // m3, mass / density of the material
  std::vector<int> material;       // index into Scene::materials
};

// Jittered (the usual): every grid cell of edge h is cut into exactly `per_cell` sub-cells of equal volume, one particle at a
// random place in each; a particle is kept if it lies inside the shape. Mass = density h^3 / per_cell. A file of points gives its
// particles as they stand. Poisson: particles keep a distance from each other and divide the shape's volume evenly. The same seed
// gives the same particles on every machine. Throws config::InputError where a file of points cannot be read, holds a value that is
// not finite, or a point outside the domain.
Particles sample(const Scene& scene);

// An upper bound of how many particles sample() makes, without making them: to tell memory before it is taken.
// Exact for files of points; throws config::InputError where one cannot be read.
std::uint64_t estimate_particles(const Scene& scene);

// The same of one piece of snow that is a solid shape, on a grid of this cell.
double estimate_particles(const Snow& snow, const Domain& domain);

// How a cell is cut for n particles: the factorisation a >= b >= c of n whose boxes are nearest to cubes, (m, m, m) for n = m^3.
// Which axis takes which factor is drawn cell by cell, so that slices of a prime n favour no direction.
std::array<int, 3> sub_cells(int n);

}  // namespace firn::scene
