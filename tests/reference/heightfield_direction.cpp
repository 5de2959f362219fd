#include "tests/reference/heightfield_direction.h"

#include "tests/catch.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {
const Direction kAppendix{FactorRule::appendix, 4};

double factor(const Vector3d& v, double x, double z, const Direction& direction) {
  return direction_factor(v, Vector2d(x, z), direction);
}
}  // namespace

TEST_CASE("factors of the printed examples [H8]") {
  for (const auto& [x, z] : {std::pair{-1, 0}, {1, 0}, {0, 1}, {0, -1}}) CHECK(factor({0, -1, 0}, x, z, kAppendix) == 0.25);
  CHECK(factor({2, -1, 0}, -1, 0, kAppendix) == Approx(0.05).margin(5e-5));
  CHECK(factor({2, -1, 0}, 1, 0, kAppendix) == Approx(0.7655).margin(5e-5));
  CHECK(factor({2, -1, 0}, 0, 1, kAppendix) == Approx(0.05).margin(5e-5));
  CHECK(factor({2, -1, 0}, 0, -1, kAppendix) == Approx(0.05).margin(5e-5));
  CHECK(factor({2, -1, 3}, -1, 0, kAppendix) == Approx(0.0179).margin(5e-5));
  CHECK(factor({2, -1, 3}, 1, 0, kAppendix) == Approx(0.5142).margin(5e-5));
  CHECK(factor({2, -1, 3}, 0, 1, kAppendix) == Approx(0.7624).margin(5e-5));
  CHECK(factor({2, -1, 3}, 0, -1, kAppendix) == Approx(0.0179).margin(5e-5));
}

TEST_CASE("the thesis's rule: the cosine to the direction of motion, plus the downward share over k") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 100; ++trial) {
    const double heading = random.uniform(-3, 3), target = random.uniform(-3, 3), dive = random.uniform(-1.5, 1.5);
    const double k = random.uniform(1, 10), speed = random.uniform(0.1, 9);
    const Vector3d v(std::cos(dive) * std::cos(heading), std::sin(dive), std::cos(dive) * std::sin(heading));
    const double cosine = std::max(0.0, std::cos(heading - target)), down = std::sin(dive) * std::sin(dive);
    const double x = std::cos(target), z = std::sin(target);
    CHECK(factor(speed * v, x, z, {FactorRule::thesis, k}) == Approx(cosine + down / k).margin(1e-13));
    const double flat = std::cos(dive);
    CHECK(factor(speed * v, x, z, {FactorRule::appendix, k}) == Approx(flat * flat * flat * cosine + down / k).margin(1e-13));
  }
}

TEST_CASE("straight down or at rest, only the downward share counts, level motion pushes nothing back") {
  const FactorRule rule = GENERATE(FactorRule::thesis, FactorRule::appendix);
  CHECK(factor({0, -3, 0}, 1, 0, {rule, 8}) == 0.125);
  CHECK(factor({0, 0, 0}, 1, 0, {rule, 8}) == 0.125);
  CHECK(factor({1, -1, 0}, 0, 0, {rule, 8}) == Approx(0.0625));  // no direction to go
  CHECK(factor({3, 0, 1}, -1, 0, {rule, 8}) == 0);
  CHECK(factor({3, 0, 1}, 1, 0, {rule, 8}) > 0.5);
}

TEST_CASE("step costs are 1/s per side, infinite where nothing is pushed") {
  const StepCosts costs = step_costs({2, -1, 3}, kAppendix);
  CHECK(costs.left == Approx(1 / factor({2, -1, 3}, -1, 0, kAppendix)));
  CHECK(costs.right == Approx(1 / factor({2, -1, 3}, 1, 0, kAppendix)));
  CHECK(costs.down == Approx(1 / factor({2, -1, 3}, 0, -1, kAppendix)));
  CHECK(costs.up == Approx(1 / factor({2, -1, 3}, 0, 1, kAppendix)));
  const StepCosts level = step_costs({1, 0, 0}, {FactorRule::thesis, 8});
  CHECK(level.right == 1);
  CHECK(std::isinf(level.left));
  CHECK(std::isinf(level.up));
  CHECK(std::isinf(level.down));
}
