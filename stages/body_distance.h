#pragma once

// Meshes as colliders: signed distances on a regular grid in the body's own axes.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stages/problem.h"

namespace firn::stages {

struct DistanceGrid {
  Eigen::Vector3d min{0, 0, 0};  // its lowest node
  double cell = 0;               // m
  Eigen::Vector3i nodes{0, 0, 0};
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(nodes.cast<std::int64_t>().prod()); }
};

// The mesh in the axes that bodies.place gives its body: those of its inertia, where it has a mass.
scene::TriangleMesh in_own_axes(const scene::Body& body, scene::TriangleMesh mesh);

// Fine enough for a simulation with cells of this size, and never more than 64 cells in the mesh's length.
DistanceGrid distance_grid(const scene::TriangleMesh& mesh, double simulation_cell);
// At its nodes, x fastest; negative inside (scene/mesh_solid.h).
std::vector<float> distances(const scene::TriangleMesh& mesh, const DistanceGrid& grid);

// One per body; nothing for other shapes, and where there are no particles.
std::vector<std::optional<DistanceGrid>> distance_grids(const Problem& problem);

}  // namespace firn::stages
