#include "scene/inertia.h"

#include <Eigen/Eigenvalues>
#include <limits>

namespace firn::scene {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Inertia of(const Plane&, double) { return {.moments = Vector3d::Constant(infinity)}; }

// Solid sphere: 2/5 m r^2.
Inertia of(const Sphere& sphere, double mass) {
  return {.center = sphere.center, .moments = Vector3d::Constant(0.4 * mass * sphere.radius * sphere.radius)};
}

// Solid box with edges a, b, c: m/12 (b^2 + c^2) about the first.
Inertia of(const Box& box, double mass) {
  const Vector3d squared = 4 * box.half_size.cwiseProduct(box.half_size);
  return {.center = box.center, .moments = mass / 12 * (Vector3d::Constant(squared.sum()) - squared)};
}

// A cylinder of length l and two half balls of radius r, each part's mass by its volume. Along the axis 1/2 and 2/5 m r^2; across
// it the cylinder's m (r^2/4 + l^2/12), and the half balls' 2/5 m r^2 moved from their flat faces' centre to the capsule's: m (2/5
// r^2 + l^2/4 + 3/8 l r), as a half ball's centre of mass lies 3/8 r from its flat face (parallel axes, twice).
Inertia of(const Capsule& capsule, double mass) {
  const Vector3d axis = capsule.end - capsule.start;
  const double length = axis.norm(), radius = capsule.radius, square = radius * radius;
  const double balls = mass * (4.0 / 3 * radius) / (length + 4.0 / 3 * radius), cylinder = mass - balls;
  const double along = square * (0.5 * cylinder + 0.4 * balls);
  const double across =
      cylinder * (square / 4 + length * length / 12) + balls * (0.4 * square + length * length / 4 + 3.0 / 8 * length * radius);
  const Quaterniond axes = length > 0 ? Quaterniond::FromTwoVectors(Vector3d::UnitX(), axis) : Quaterniond::Identity();
  return {.center = 0.5 * (capsule.start + capsule.end), .axes = axes, .moments = {along, across, across}};
}

Inertia of(const Mesh& mesh, double mass) { return inertia_of(read_mesh(mesh.file, mesh.scale), mass); }

}  // namespace

Inertia inertia_of(const Shape& shape, double mass) {
  return std::visit([&](const auto& each) { return of(each, mass); }, shape);
}

Inertia inertia_of(const TriangleMesh& mesh, double mass) {
  const MassProperties properties = mass_properties(mesh);
  Inertia result;
  result.center = properties.center;
  if (!(properties.volume > 0)) {  // an open mesh without thickness: nothing tells how its mass is spread
    result.moments.setConstant(infinity);
    return result;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(properties.inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  result.axes = Quaterniond(axes);
  result.moments = mass / properties.volume * solver.eigenvalues();
  return result;
}

Inertia inertia_of(const Body& body) {
  if (body.mass) return inertia_of(body.shape, *body.mass);
  return {.moments = Vector3d::Constant(infinity)};
}

}  // namespace firn::scene
