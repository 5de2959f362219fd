#pragma once

// Rigid bodies as triangles, for files.

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace firn::stages {

// As bodies.place leaves it: kind and size of body_kind and body_size, corners of triangles (three each) of facet_points.
struct BodyShape {
  int kind = 0;
  Eigen::Vector4d size{0, 0, 0, 0};
  std::vector<Eigen::Vector3d> corners;
};

// The body's surface in its own axes, seen from outside counter-clockwise. A half-space becomes a square of `plane_edge` m.
scene::TriangleMesh mesh_of(const BodyShape& shape, double plane_edge);

scene::TriangleMesh placed(scene::TriangleMesh mesh, const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);

}  // namespace firn::stages
