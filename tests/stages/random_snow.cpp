#include "tests/stages/random_snow.h"

#include <cmath>
#include <limits>

namespace firn::test {

using reference::Collider;
using reference::Shape;

RandomSnow::RandomSnow(std::uint64_t seed, int count) : random(seed) {
  grid = {Vector3d(-0.5, 0.25, 0), 0.125, Eigen::Vector3i(14, 11, 12)};
  materials = {{1.4e5, 0.2, 10, 2.5e-2, 7.5e-3, 400}, {5e6, 0.3, 30, 2e-2, 2e-3, 350}};
  for (reference::Material& m : materials) {
    m.critical_compression = single(m.critical_compression);
    m.critical_stretch = single(m.critical_stretch);
  }
  const auto uniform = [&](double low, double high) { return random.uniform(low, high); };
  const auto vector = [&](double size) { return Vector3d(uniform(-size, size), uniform(-size, size), uniform(-size, size)); };
  for (int p = 0; p < count; ++p) {
    Vector3d x;
    for (int axis = 0; axis < 3; ++axis) x[axis] = grid.min[axis] + grid.h * uniform(2, grid.nodes[axis] - 3);
    particles.add(single(x), single(vector(5)), single(uniform(0.5, 2) * 1e-2), single(uniform(1, 4) * 1e-5), p % 2);
    Matrix3d f = Matrix3d::Identity(), g;
    for (int i = 0; i < 9; ++i) f.data()[i] += uniform(-0.02, 0.02);
    for (int i = 0; i < 9; ++i) g.data()[i] = uniform(-30, 30);
    particles.elastic.back() = single(f);
    particles.plastic_det.back() = single(uniform(0.95, 1.05));
    gradient.push_back(single(g));
  }
  for (const Shape shape : {Shape::plane, Shape::sphere, Shape::box, Shape::capsule}) {
    Collider c;
    c.shape = shape;
    c.position = single(Vector3d(grid.min + grid.h * Vector3d(uniform(4, 9), uniform(3, 6), uniform(4, 8))));
    const Eigen::Quaterniond q(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    c.orientation.coeffs() = q.normalized().coeffs().cast<float>().cast<double>();
    c.half_size = shape == Shape::capsule ? Vector3d(0, 0.25, 0) : Vector3d(0.25, 0.125, 0.1875);
    c.radius = 0.1875;
    c.velocity = single(vector(2));
    c.spin = single(vector(3));
    c.friction = single(uniform(0, 0.6));
    colliders.push_back(c);
  }
}

GridSetup RandomSnow::setup() const {
  GridSetup setup;
  setup.particles = static_cast<std::uint64_t>(particles.count());
  setup.materials = materials.size();
  setup.bodies = colliders.size();
  setup.grid_min = {grid.min.x(), grid.min.y(), grid.min.z()};
  setup.cell = grid.h;
  setup.nodes = {grid.nodes.x(), grid.nodes.y(), grid.nodes.z()};
  setup.crowd = 16;
  setup.mass_bound = 125.0 / 27.0 * setup.crowd * 2e-2;
  setup.momentum_bound = setup.mass_bound * 9;
  return setup;
}

Arrays RandomSnow::arrays(std::initializer_list<const char*> ports) const {
  Arrays all;
  all.floats = {{"position", flat(particles.position)}, {"velocity", flat(particles.velocity)},
                {"mass", flat(particles.mass)},         {"volume", flat(particles.volume)},
                {"elastic", flat(particles.elastic)},   {"plastic_det", flat(particles.plastic_det)},
                {"velocity_gradient", flat(gradient)}};
  all.integers["material"] = {particles.material.begin(), particles.material.end()};
  for (const reference::Material& m : materials) {
    const reference::Lame lame = reference::lame(m);
    for (const double value : {lame.mu, lame.lambda, m.hardening, m.density})
      all.floats["material_elastic"].push_back(static_cast<float>(value));
    for (const double value : {m.critical_compression, m.critical_stretch})
      all.floats["material_plastic"].push_back(static_cast<float>(value));
  }
  const auto append = [](std::vector<float>& to, std::initializer_list<double> values) {
    for (const double value : values) to.push_back(static_cast<float>(value));
  };
  for (const Collider& c : colliders) {
    all.integers["body_kind"].push_back(static_cast<int>(c.shape));
    const bool box = c.shape == Shape::box;
    append(all.floats["body_size"], {box ? c.half_size.x() : c.radius, c.half_size.y(), c.half_size.z(), 0});
    append(all.floats["body_position"], {c.position.x(), c.position.y(), c.position.z()});
    append(all.floats["body_orientation"], {c.orientation.x(), c.orientation.y(), c.orientation.z(), c.orientation.w()});
    append(all.floats["body_velocity"], {c.velocity.x(), c.velocity.y(), c.velocity.z()});
    append(all.floats["body_spin"], {c.spin.x(), c.spin.y(), c.spin.z()});
    append(all.floats["body_friction"], {c.friction});
  }
  Arrays wanted;
  for (const char* port : ports) {
    if (all.floats.contains(port)) wanted.floats[port] = all.floats[port];
    if (all.integers.contains(port)) wanted.integers[port] = all.integers[port];
  }
  return wanted;
}

std::vector<float> flat(const std::vector<double>& values) { return {values.begin(), values.end()}; }
std::vector<float> flat(const std::vector<Vector3d>& values) {
  std::vector<float> result;
  for (const Vector3d& v : values)
    for (int i = 0; i < 3; ++i) result.push_back(static_cast<float>(v[i]));
  return result;
}
std::vector<float> flat(const std::vector<Matrix3d>& values) {
  std::vector<float> result;
  for (const Matrix3d& m : values)
    for (int i = 0; i < 9; ++i) result.push_back(static_cast<float>(m(i / 3, i % 3)));
  return result;
}

double relative_error(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size() || a.empty()) return std::numeric_limits<double>::infinity();
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i])) return std::numeric_limits<double>::infinity();
    difference = std::max(difference, std::abs(static_cast<double>(a[i]) - b[i]));
    size = std::max(size, std::abs(static_cast<double>(b[i])));
  }
  return size > 0 ? difference / size : difference;
}

}  // namespace firn::test
