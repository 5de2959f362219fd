#pragma once

// Triangle meshes of bodies: OBJ, PLY and STL files.

#include <array>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace firn::scene {

struct TriangleMesh {
  std::vector<Vector3d> points;               // m, in the body's own axes; no two in one place
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside, where the mesh is closed
  std::size_t without_area = 0;               // triangles of the file that were left out
};

// The mesh with its points times `scale`. Polygons become triangles, corners in one place become one point, triangles without
// area are dropped, a closed mesh that is inside out is turned. Throws std::runtime_error with a sentence that names the file:
// not found, of another kind, broken, without triangles, with a coordinate that is no finite number.
TriangleMesh read_mesh(const std::string& file, double scale);

// One per body of the scene, empty for bodies of other shapes; equal files are read once. Throws config::InputError with every
// mesh that cannot be read, at its body's place.
std::vector<TriangleMesh> body_meshes(const Scene& scene);

// Every edge borders as many triangles in one direction as in the other: the surface has an inside.
bool is_closed(const TriangleMesh& mesh);

// Of a closed mesh filled with 1 kg/m3; of one that is not closed, of the box round its points instead.
struct MassProperties {
  double volume = 0;                                  // m3
  Vector3d center{0, 0, 0};                           // m, centre of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // kg m2 about the centre, own axes
  bool closed = false;
};
MassProperties mass_properties(const TriangleMesh& mesh);

}  // namespace firn::scene
