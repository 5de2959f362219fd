#pragma once

// Geometry of the solid shapes (sphere, box, capsule), turned about their centre: what is inside, how far they reach.

#include <cstdint>
#include <optional>
#include <variant>

#include "scene/scene.h"

namespace firn::scene {

struct Bounds {
  Vector3d min{0, 0, 0}, max{0, 0, 0};
};

using SolidShape = std::variant<Sphere, Box, Capsule>;
struct Solid {
  SolidShape shape;
  Quaterniond orientation = Quaterniond::Identity();  // turns the shape about its own centre
};

// The solid that a piece of snow fills; nothing for meshes and files of points.
std::optional<Solid> solid_of(const Snow& snow);
// A body's shape in world axes where the body stands at `position` and `orientation`; nothing for planes and meshes.
std::optional<Solid> solid_of(const Body& body, const Vector3d& position, const Quaterniond& orientation);

const char* name_of(const SolidShape& shape);  // "sphere", "box", "capsule"
Vector3d center_of(const SolidShape& shape);
Bounds bounds_of(const Solid& solid);

// Tests points one by one; made once per solid.
class Inside {
 public:
  explicit Inside(const Solid& solid);
  [[nodiscard]] bool operator()(const Vector3d& point) const;  // the surface counts as inside
  [[nodiscard]] double distance(const Vector3d& point) const;  // from the solid, m; 0 inside

 private:
  SolidShape shape_;
  Vector3d center_;
  Eigen::Matrix3d to_own_axes_;
};

// Volume of all points within `distance` of the solid, itself included, m3.
double grown_volume(const Solid& solid, double distance);

}  // namespace firn::scene
