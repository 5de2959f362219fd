#include "scene/solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/repeatable.h"

namespace firn::scene {

namespace {

template <typename... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <typename... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace

std::optional<Solid> solid_of(const Snow& snow) {
  return std::visit(Overloaded{[](const SolidMesh&) -> std::optional<Solid> { return std::nullopt; },
                               [](const PointFile&) -> std::optional<Solid> { return std::nullopt; },
                               [&](const auto& shape) -> std::optional<Solid> {
                                 return Solid{shape, snow.orientation};
                               }},
                    snow.what);
}

std::optional<Solid> solid_of(const Body& body, const Vector3d& position, const Quaterniond& orientation) {
  using Result = std::optional<Solid>;
  return std::visit(
      Overloaded{[](const Plane&) -> Result { return std::nullopt; }, [](const Mesh&) -> Result { return std::nullopt; },
                 [&](Sphere sphere) -> Result {
                   sphere.center = position + orientation * sphere.center;
                   return Solid{sphere, orientation};
                 },
                 [&](Box box) -> Result {
                   box.center = position + orientation * box.center;
                   return Solid{box, orientation};
                 },
                 [&](Capsule capsule) -> Result {
                   // Turned about its middle by the orientation of the solid, so only the middle is placed here.
                   const Vector3d middle = 0.5 * (capsule.start + capsule.end);
                   const Vector3d shift = position + orientation * middle - middle;
                   capsule.start += shift;
                   capsule.end += shift;
                   return Solid{capsule, orientation};
                 }},
      body.shape);
}

const char* name_of(const SolidShape& shape) {
  constexpr const char* names[] = {"sphere", "box", "capsule"};
  return names[shape.index()];
}

Vector3d center_of(const SolidShape& shape) {
  return std::visit(Overloaded{[](const Capsule& capsule) -> Vector3d { return 0.5 * (capsule.start + capsule.end); },
                               [](const auto& other) -> Vector3d { return other.center; }},
                    shape);
}

Bounds bounds_of(const Solid& solid) {
  const Eigen::Matrix3d rotation = solid.orientation.toRotationMatrix();
  const Vector3d reach = std::visit(Overloaded{[](const Sphere& sphere) -> Vector3d { return Vector3d::Constant(sphere.radius); },
                                               [&](const Box& box) -> Vector3d { return rotation.cwiseAbs() * box.half_size; },
                                               [&](const Capsule& capsule) -> Vector3d {
                                                 const Vector3d half_axis = rotation * (0.5 * (capsule.end - capsule.start));
                                                 return half_axis.cwiseAbs() + Vector3d::Constant(capsule.radius);
                                               }},
                                    solid.shape);
  const Vector3d center = center_of(solid.shape);
  return {center - reach, center + reach};
}

Inside::Inside(const Solid& solid)
    : shape_(solid.shape), center_(center_of(solid.shape)), to_own_axes_(solid.orientation.toRotationMatrix().transpose()) {}

bool Inside::operator()(const Vector3d& point) const {
  const Vector3d from_center = point - center_;
  if (const auto* sphere = std::get_if<Sphere>(&shape_))
    return repeatable_dot(from_center, from_center) <= sphere->radius * sphere->radius;

  const Vector3d own(repeatable_dot(to_own_axes_.row(0).transpose(), from_center),
                     repeatable_dot(to_own_axes_.row(1).transpose(), from_center),
                     repeatable_dot(to_own_axes_.row(2).transpose(), from_center));
  if (const auto* box = std::get_if<Box>(&shape_)) {
    return std::abs(own.x()) <= box->half_size.x() && std::abs(own.y()) <= box->half_size.y() &&
           std::abs(own.z()) <= box->half_size.z();
  }
  const auto& capsule = std::get<Capsule>(shape_);
  const Vector3d half_axis = 0.5 * (capsule.end - capsule.start);
  const double length_squared = repeatable_dot(half_axis, half_axis);
  const double along = length_squared > 0 ? std::clamp(repeatable_dot(own, half_axis) / length_squared, -1.0, 1.0) : 0.0;
  const Vector3d off_axis(std::fma(-along, half_axis.x(), own.x()), std::fma(-along, half_axis.y(), own.y()),
                          std::fma(-along, half_axis.z(), own.z()));
  return repeatable_dot(off_axis, off_axis) <= capsule.radius * capsule.radius;
}

double Inside::distance(const Vector3d& point) const {
  const Vector3d own = to_own_axes_ * (point - center_);
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) return std::max(own.norm() - sphere->radius, 0.0);
  if (const auto* box = std::get_if<Box>(&shape_)) return (own.cwiseAbs() - box->half_size).cwiseMax(0).norm();
  const auto& capsule = std::get<Capsule>(shape_);
  const Vector3d half_axis = 0.5 * (capsule.end - capsule.start);
  const double along = std::clamp(own.dot(half_axis) / half_axis.squaredNorm(), -1.0, 1.0);
  return std::max((own - along * half_axis).norm() - capsule.radius, 0.0);
}

double grown_volume(const Solid& solid, double distance) {
  constexpr double pi = std::numbers::pi;
  return std::visit(Overloaded{[&](const Sphere& sphere) {
                                 const double radius = sphere.radius + distance;
                                 return 4.0 / 3.0 * pi * radius * radius * radius;
                               },
                               [&](const Box& box) {
                                 const Vector3d size = 2 * box.half_size;
                                 const double faces = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
                                 return size.prod() + faces * distance + pi * size.sum() * distance * distance +
                                        4.0 / 3.0 * pi * distance * distance * distance;
                               },
                               [&](const Capsule& capsule) {
                                 const double radius = capsule.radius + distance;
                                 const double length = (capsule.end - capsule.start).norm();
                                 return pi * radius * radius * (length + 4.0 / 3.0 * radius);
                               }},
                    solid.shape);
}

}  // namespace firn::scene
