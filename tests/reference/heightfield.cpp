#include "tests/reference/heightfield.h"

#include "tests/catch.h"
#include "tests/reference/fields.h"

using namespace firn::reference;

TEST_CASE("snow under moving bodies keeps its mass through all stages, step after step") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const bool along_contour = GENERATE(true, false);
  Field field = random_field(random, 32, 32, 0.1);
  field.ground *= 0.2;
  const double before = mass(field);
  const std::vector<Vector3d> velocity{{1, -0.2, 0.4}, {-0.8, -0.3, 0.2}};
  std::vector<Vector3d> position;
  for (const double x : {0.8, 2.4}) position.emplace_back(field.origin.x() + x, 0.8, field.origin.y() + 1);
  double displaced = 0;
  for (int step = 0; step < 40; ++step) {
    Underside bodies = nothing_above(32, 32);
    for (int b = 0; b < 2; ++b) add_ball(bodies, field, b, position[b] += 0.05 * velocity[b], 0.5);
    const Cells d = overlap(field, bodies);
    const Amounts pushed = compress(field, d, {});
    displaced += pushed.mass.sum();
    if (along_contour) {
      deposit(field, distribute_contour(pushed, d, bodies.owner, velocity, {}));
    } else {
      const Direction direction{FactorRule::thesis, 4};
      const Cells distance =
          distance_transform(d, bodies.owner, {step_costs(velocity[0], direction), step_costs(velocity[1], direction)});
      deposit(field, distribute_distance(pushed, distance, 8));
    }
    for (int i = 0; i < 4; ++i) field = flatten(field, bodies.height, {0.6, Diagonal::euclidean, 0.5}).field;
    CHECK(field.snow.minCoeff() >= 0);
    CHECK(field.density.minCoeff() > 0);
  }
  CHECK(displaced > 0.05 * before);
  CHECK(mass(field) == Approx(before).epsilon(1e-11));
}
