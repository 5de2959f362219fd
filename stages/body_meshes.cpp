#include "stages/body_meshes.h"

#include <cmath>
#include <numbers>

namespace firn::stages {
namespace {

using scene::TriangleMesh;
using scene::Vector3d;

// A sphere of this radius about the origin, cut at its equator and drawn apart along y by twice `half_length`.
TriangleMesh capsule(double radius, double half_length) {
  constexpr int around = 48, rings = 12;  // rings of a half
  TriangleMesh mesh;
  mesh.points.emplace_back(0, -half_length - radius, 0);
  for (int half = 0; half < 2; ++half)
    for (int ring = 0; ring < rings; ++ring) {
      const double latitude =
          half == 0 ? -0.5 * std::numbers::pi * (rings - 1 - ring) / rings : 0.5 * std::numbers::pi * ring / rings;
      for (int i = 0; i < around; ++i) {
        const double turn = 2 * std::numbers::pi * i / around;
        mesh.points.emplace_back(radius * std::cos(latitude) * std::cos(turn),
                                 radius * std::sin(latitude) + (half == 0 ? -half_length : half_length),
                                 radius * std::cos(latitude) * std::sin(turn));
      }
    }
  const int top = static_cast<int>(mesh.points.size());
  mesh.points.emplace_back(0, half_length + radius, 0);
  const int last = 2 * rings - 1;
  const auto at = [&](int ring, int i) { return 1 + ring * around + i % around; };
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({0, at(0, i), at(0, i + 1)});
    for (int ring = 0; ring < last; ++ring) {
      if (half_length == 0 && ring == rings - 1) continue;  // both rings are the equator
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
    }
    mesh.triangles.push_back({at(last, i), top, at(last, i + 1)});
  }
  if (half_length > 0) return mesh;
  // The two equators as one.
  const int below = at(rings - 1, 0), above = at(rings, 0);
  for (std::array<int, 3>& triangle : mesh.triangles)
    for (int& corner : triangle) {
      if (corner >= above && corner < above + around)
        corner -= above - below;
      else if (corner >= above + around)
        corner -= around;
    }
  mesh.points.erase(mesh.points.begin() + above, mesh.points.begin() + above + around);
  return mesh;
}

TriangleMesh box(const Vector3d& half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.points.emplace_back((i & 1) != 0 ? half.x() : -half.x(), (i & 2) != 0 ? half.y() : -half.y(),
                             (i & 4) != 0 ? half.z() : -half.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

}  // namespace

TriangleMesh mesh_of(const BodyShape& shape, double plane_edge) {
  TriangleMesh mesh;
  switch (shape.kind) {
    case 0: {
      const double half = 0.5 * plane_edge;
      mesh.points = {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}};
      mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
      return mesh;
    }
    case 1:
      return capsule(shape.size.x(), 0);
    case 2:
      return box(shape.size.head<3>());
    case 3:
      return capsule(shape.size.x(), shape.size.y());
    default:
      mesh.points = shape.corners;
      for (int i = 0; i + 2 < static_cast<int>(shape.corners.size()); i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
      return mesh;
  }
}

TriangleMesh placed(TriangleMesh mesh, const Vector3d& position, const Eigen::Quaterniond& orientation) {
  const Eigen::Matrix3d turn = orientation.normalized().toRotationMatrix();
  for (Vector3d& point : mesh.points) point = position + turn * point;
  return mesh;
}

}  // namespace firn::stages
