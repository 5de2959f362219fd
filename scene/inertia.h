#pragma once

// How hard bodies are to turn.

#include "scene/mesh.h"
#include "scene/scene.h"

namespace firn::scene {

struct Inertia {
  Vector3d center{0, 0, 0};                    // m, centre of mass in the body's own axes
  Quaterniond axes = Quaterniond::Identity();  // turns the principal axes into the body's own
  Vector3d moments{0, 0, 0};                   // kg m2 about the principal axes through the centre
};

// Of `mass` kg spread evenly over the shape. Half-spaces do not turn: infinite moments. A mesh is read from its file; where it is
// not closed the box round it stands for it (scene/mesh.h). The capsule's symmetry axis is its first principal axis.
Inertia inertia_of(const Shape& shape, double mass);
Inertia inertia_of(const TriangleMesh& mesh, double mass);
// Of a body without a mass, which nothing turns: infinite moments about the shape's own centre.
Inertia inertia_of(const Body& body);

}  // namespace firn::scene
