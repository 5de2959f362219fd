#include "tests/reference/interpolation.h"

#include "tests/catch.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {
const Grid kGrid{{-1, 0.5, 2}, 0.3, {9, 10, 11}};

Vector3d inner_point(Random& random) {
  Vector3d point;
  for (int axis = 0; axis < 3; ++axis) {
    point[axis] = kGrid.min[axis] + kGrid.h * random.uniform(1.01, static_cast<double>(kGrid.nodes[axis]) - 2.01);
  }
  return point;
}
}  // namespace

TEST_CASE("the one-dimensional weights have their known values at nodes and half-way") {
  CHECK(weight(Kernel::cubic, 0) == Approx(2.0 / 3));
  CHECK(weight(Kernel::cubic, -1) == Approx(1.0 / 6));
  CHECK(weight(Kernel::cubic, 0.5) == Approx(23.0 / 48));
  CHECK(weight(Kernel::cubic, 1.5) == Approx(1.0 / 48));
  CHECK(weight(Kernel::cubic, 2) == 0);
  CHECK(weight(Kernel::quadratic, 0) == Approx(0.75));
  CHECK(weight(Kernel::quadratic, 0.5) == Approx(0.5));
  CHECK(weight(Kernel::quadratic, -1) == Approx(0.125));
  CHECK(weight(Kernel::quadratic, 1.5) == 0);
}

TEST_CASE("the one-dimensional derivative is that of the weight, and both are continuous") {
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const double e = 1e-5;
  for (int i = -2500; i <= 2500; ++i) {
    const double u = i * 1e-3 + 3.3e-4;  // off the knots
    CAPTURE(u);
    const double numeric = (weight(kernel, u + e) - weight(kernel, u - e)) / (2 * e);
    CHECK(std::abs(weight_derivative(kernel, u) - numeric) < 1e-9);
  }
  for (const double knot : {-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0}) {
    CAPTURE(knot);
    CHECK(std::abs(weight(kernel, knot + e) - weight(kernel, knot - e)) < 3 * e);
    CHECK(std::abs(weight_derivative(kernel, knot + e) - weight_derivative(kernel, knot - e)) < 6 * e);
  }
}

TEST_CASE("weights of a particle sum to one, are centred on it, and reproduce linear fields") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d point = inner_point(random);
    double sum = 0;
    Vector3d gradient_sum = Vector3d::Zero(), first_moment = Vector3d::Zero();
    Eigen::Matrix3d position_gradient = Eigen::Matrix3d::Zero();
    const std::vector<Neighbor> around = neighbors(kGrid, kernel, point);
    for (const Neighbor& n : around) {
      const Vector3d offset = kGrid.position(n.node) - point;
      CHECK(n.weight >= 0);
      sum += n.weight;
      gradient_sum += n.gradient;
      first_moment += n.weight * offset;
      position_gradient += offset * n.gradient.transpose();
    }
    CHECK(around.size() == (kernel == Kernel::cubic ? 64u : 27u));
    CHECK(sum == Approx(1).epsilon(1e-13));
    CHECK(gradient_sum.norm() < 1e-13 / kGrid.h);
    CHECK(first_moment.norm() < 1e-13);
    // sum_i x_i grad w^T = I: the gradient of a field linear in x comes out exactly.
    CHECK((position_gradient - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  }
}

TEST_CASE("weight gradients are the weights' derivatives by the particle's position, in 1/m") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const double e = 1e-6;
  auto weight_of = [&](int node, const Vector3d& point) {
    for (const Neighbor& n : neighbors(kGrid, kernel, point)) {
      if (n.node == node) return n.weight;
    }
    return 0.0;
  };
  for (int trial = 0; trial < 5; ++trial) {
    const Vector3d point = inner_point(random);
    for (const Neighbor& n : neighbors(kGrid, kernel, point)) {
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d shift = e * Vector3d::Unit(axis);
        const double numeric = (weight_of(n.node, point + shift) - weight_of(n.node, point - shift)) / (2 * e);
        CHECK(std::abs(n.gradient[axis] - numeric) < 2e-5);
      }
    }
  }
}

TEST_CASE("no node with weight is missing from a particle's neighbours") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const Vector3d point = inner_point(random);
  const std::vector<Neighbor> around = neighbors(kGrid, kernel, point);
  for (int node = 0; node < kGrid.count(); ++node) {
    const Vector3d u = (point - kGrid.position(node)) / kGrid.h;
    const double expected = weight(kernel, u.x()) * weight(kernel, u.y()) * weight(kernel, u.z());
    double found = 0;
    for (const Neighbor& n : around) found += n.node == node ? n.weight : 0;
    CHECK(found == Approx(expected).margin(1e-15));
  }
}

TEST_CASE("nodes are counted with i fastest, then j, then k, from min on") {
  CHECK(kGrid.index(1, 0, 0) == 1);
  CHECK(kGrid.index(0, 1, 0) == 9);
  CHECK(kGrid.index(0, 0, 1) == 90);
  CHECK(kGrid.count() == 990);
  CHECK((kGrid.position(kGrid.index(2, 3, 4)) - Vector3d(-1 + 0.6, 0.5 + 0.9, 2 + 1.2)).norm() < 1e-14);
}

TEST_CASE("a particle whose nodes are not all on the grid is an error") {
  CHECK_THROWS_AS(neighbors(kGrid, Kernel::cubic, kGrid.min + kGrid.h * Vector3d(0.9, 4, 4)), std::out_of_range);
  CHECK_THROWS_AS(neighbors(kGrid, Kernel::cubic, kGrid.min + kGrid.h * Vector3d(4, 8.1, 4)), std::out_of_range);
  CHECK_THROWS_AS(neighbors(kGrid, Kernel::cubic, Vector3d(std::nan(""), 1.5, 3)), std::out_of_range);
  CHECK(neighbors(kGrid, Kernel::cubic, kGrid.min + 1.01 * Vector3d::Constant(kGrid.h)).size() == 64);
  CHECK(neighbors(kGrid, Kernel::quadratic, kGrid.min + 1.01 * Vector3d::Constant(kGrid.h)).size() == 27);
}
