#pragma once

// Rigid colliders with friction, M4 [M 4.4].

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "tests/reference/particles.h"

namespace firn::reference {

using Eigen::Quaterniond;

enum class Shape { plane, sphere, box, capsule };

struct Collider {
  Shape shape = Shape::plane;
  Vector3d position{0, 0, 0};  // m: a point of the plane, the centre of the others
  Quaterniond orientation = Quaterniond::Identity();
  Vector3d normal{0, 1, 0};     // plane: unit, before `orientation`; snow is on the side it points to
  Vector3d half_size{0, 0, 0};  // box, m; a capsule's segment is position -+ orientation (0, half_size.y, 0)
  double radius = 0;            // sphere and capsule, m
  Vector3d velocity{0, 0, 0};   // of `position`, m/s
  Vector3d spin{0, 0, 0};       // about `position`, rad/s, world axes
  double friction = 0;          // mu
};

struct Distance {
  double signed_distance;  // m, negative inside
  Vector3d normal;         // outward, unit: the gradient of the distance
};

// Distance and normal of a sphere; its centre has no normal, up stands in for it.
inline Distance sphere_distance(const Vector3d& from_center, double radius) {
  const double length = from_center.norm();
  return {length - radius, length > 0 ? Vector3d(from_center / length) : Vector3d(0, 1, 0)};
}

// Distance and normal in the box's own axes. Inside, the nearest face counts; of equally near ones the first of x, y, z.
inline Distance box_distance(const Vector3d& local, const Vector3d& half_size) {
  const Vector3d excess = local.cwiseAbs() - half_size;
  const Vector3d side = local.unaryExpr([](double value) { return value < 0 ? -1.0 : 1.0; });
  const Vector3d outside = excess.cwiseMax(0);
  if (outside.norm() > 0) return {outside.norm(), outside.normalized().cwiseProduct(side)};
  Eigen::Index axis = 0;
  const double depth = excess.maxCoeff(&axis);
  return {depth, side[axis] * Vector3d::Unit(axis)};
}

inline Distance distance(const Collider& c, const Vector3d& point) {
  const Vector3d world = point - c.position;
  const Vector3d local = c.orientation.conjugate() * world;
  Distance result{};
  switch (c.shape) {
    case Shape::plane:
      result = {local.dot(c.normal), c.normal};
      break;
    case Shape::sphere:
      result = sphere_distance(local, c.radius);
      break;
    case Shape::box:
      result = box_distance(local, c.half_size);
      break;
    case Shape::capsule: {
      const double along = std::min(std::max(local.y(), -c.half_size.y()), c.half_size.y());
      result = sphere_distance(local - Vector3d(0, along, 0), c.radius);
      break;
    }
  }
  result.normal = c.orientation * result.normal;
  return result;
}

// v_c at a point that moves with the collider, m/s.
inline Vector3d velocity_at(const Collider& c, const Vector3d& point) { return c.velocity + c.spin.cross(point - c.position); }

// The velocity after contact. A point on the surface counts as inside (Stomakhin 2013: phi <= 0).
inline Vector3d collide(const Vector3d& velocity, const Vector3d& point, const Collider& c) {
  const Distance d = distance(c, point);
  if (d.signed_distance > 0) return velocity;
  const Vector3d surface_velocity = velocity_at(c, point);
  const Vector3d relative = velocity - surface_velocity;
  const double normal_speed = relative.dot(d.normal);
  if (normal_speed >= 0) return velocity;
  const Vector3d tangential = relative - normal_speed * d.normal;
  const double tangential_speed = tangential.norm();
  if (tangential_speed <= -c.friction * normal_speed) return surface_velocity;
  return tangential + c.friction * normal_speed * tangential / tangential_speed + surface_velocity;
}

// Several colliders, one after the other in their order.
inline Vector3d collide(Vector3d velocity, const Vector3d& point, const std::vector<Collider>& colliders) {
  for (const Collider& c : colliders) velocity = collide(velocity, point, c);
  return velocity;
}

// Step 9.
inline void particle_collide(Particles& particles, const std::vector<Collider>& colliders) {
  for (int p = 0; p < particles.count(); ++p) {
    particles.velocity[p] = collide(particles.velocity[p], particles.position[p], colliders);
  }
}

// Step 10, the colliders' part: each turns about its own position.
inline void advance(std::vector<Collider>& colliders, double dt) {
  for (Collider& c : colliders) {
    c.position += dt * c.velocity;
    const double angle = dt * c.spin.norm();
    if (angle > 0) c.orientation = (Quaterniond(Eigen::AngleAxisd(angle, c.spin.normalized())) * c.orientation).normalized();
  }
}

}  // namespace firn::reference
