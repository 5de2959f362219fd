#include "stages/snow_surface.h"

#include "stages/export.h"
#include "stages/vdb_files.h"

namespace firn::stages {

std::vector<graph::ParameterSpec> surface_parameters(double level) {
  return {{.name = "cell",
           .initial = 1.0,
           .min = 0.25,
           .max = 4.0,
           .unit = "1",
           .doc = "edge of the mesh's cells, in cells of the grid; below the distance of particles it has holes"},
          {.name = "level",
           .initial = level,
           .min = 0.01,
           .max = 2.0,
           .unit = "1",
           .doc = "share of space, as snow was laid, that counts as inside"},
          {.name = "smoothing",
           .kind = graph::ParameterKind::integer,
           .initial = std::int64_t{1},
           .min = 0,
           .max = 20,
           .unit = "1",
           .doc = "passes that even out the density before"}};
}

SurfaceShape surface_shape(const graph::ParameterValues& parameters) {
  return {number(parameters, "cell"), number(parameters, "level"), integer(parameters, "smoothing")};
}

NodeField share_of_snow(std::span<const float> position, std::span<const float> volume, std::span<const float> carried,
                        const scene::Domain& domain, const SurfaceShape& shape) {
  return node_field(position, carried, volume, domain.min, shape.cell * domain.cell);
}

scene::TriangleMesh snow_surface(const NodeField& share, const SurfaceShape& shape) {
  return surface_of(share, shape.level, shape.smoothing);
}

std::vector<std::array<float, 3>> outward_normals(const scene::TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> sums(mesh.points.size(), Eigen::Vector3d::Zero());
  const auto point = [&](int corner) -> const Eigen::Vector3d& { return mesh.points[static_cast<std::size_t>(corner)]; };
  for (const std::array<int, 3>& t : mesh.triangles) {
    const Eigen::Vector3d area = (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
    for (const int corner : t) sums[static_cast<std::size_t>(corner)] += area;
  }
  std::vector<std::array<float, 3>> normals;
  normals.reserve(sums.size());
  for (const Eigen::Vector3d& sum : sums) {
    const Eigen::Vector3f unit = sum.stableNormalized().cast<float>();
    normals.push_back({unit.x(), unit.y(), unit.z()});
  }
  return normals;
}

}  // namespace firn::stages
