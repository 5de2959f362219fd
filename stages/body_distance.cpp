#include "stages/body_distance.h"

#include <algorithm>

#include "scene/inertia.h"
#include "scene/mesh_solid.h"

namespace firn::stages {

scene::TriangleMesh in_own_axes(const scene::Body& body, scene::TriangleMesh mesh) {
  if (!body.mass) return mesh;
  const scene::Inertia inertia = scene::inertia_of(mesh, *body.mass);
  for (scene::Vector3d& point : mesh.points) point = inertia.axes.conjugate() * (point - inertia.center);
  return mesh;
}

DistanceGrid distance_grid(const scene::TriangleMesh& mesh, double simulation_cell) {
  scene::Vector3d low = mesh.points.front(), high = low;
  for (const scene::Vector3d& point : mesh.points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double length = (high - low).maxCoeff();
  DistanceGrid grid;
  grid.cell = std::clamp(0.5 * simulation_cell, length / 64, length / 16);
  grid.min = low - scene::Vector3d::Constant(1.5 * grid.cell);
  grid.nodes = ((high - low) / grid.cell).array().ceil().cast<int>() + 4;
  return grid;
}

std::vector<float> distances(const scene::TriangleMesh& mesh, const DistanceGrid& grid) {
  scene::TriangleMesh repaired = mesh;
  scene::repair(repaired);
  const scene::MeshSolid solid(std::move(repaired));
  const double reach = grid.cell * grid.nodes.cast<double>().norm();
  std::vector<float> values;
  values.reserve(grid.count());
  for (int z = 0; z < grid.nodes.z(); ++z)
    for (int y = 0; y < grid.nodes.y(); ++y)
      for (int x = 0; x < grid.nodes.x(); ++x) {
        const scene::Vector3d point = grid.min + grid.cell * scene::Vector3d(x, y, z);
        const double distance = solid.distance(point, reach);
        values.push_back(static_cast<float>(solid.inside(point) ? -distance : distance));
      }
  return values;
}

std::vector<std::optional<DistanceGrid>> distance_grids(const Problem& problem) {
  std::vector<std::optional<DistanceGrid>> grids(problem.scene.bodies.size());
  if (!problem.scene.has_particles()) return grids;
  for (std::size_t b = 0; b < grids.size(); ++b)
    if (!problem.meshes[b].triangles.empty())
      grids[b] = distance_grid(in_own_axes(problem.scene.bodies[b], problem.meshes[b]), problem.scene.domain->cell);
  return grids;
}

}  // namespace firn::stages
