#include "tests/reference/heightfield_flatten.h"

#include "tests/catch.h"
#include "tests/reference/fields.h"

using namespace firn::reference;

namespace {
Cells open_sky(const Field& field) { return nothing_above(field.rows(), field.columns()).height; }

// Steepest step down to a neighbour beyond `slope`, in m, over snow that can still slide.
double worst_excess(const Field& field, double slope) {
  const Cells height = field.surface();
  double worst = 0;
  for (int z = 0; z < field.rows(); ++z) {
    for (int x = 0; x < field.columns(); ++x) {
      for (const Offset& step : kNeighbors) {
        if (!inside(height, z + step.z, x + step.x) || field.snow(z, x) <= 0) continue;
        const double length = field.h * std::hypot(step.z, step.x);
        worst = std::max(worst, height(z, x) - height(z + step.z, x + step.x) - slope * length);
      }
    }
  }
  return worst;
}
}  // namespace

TEST_CASE("a lone pillar gives the mean excess of its eight sides, in equal parts") {
  Field field = flat_field(5, 5, 0.5, 0, 100);
  field.snow(2, 2) = 1;
  SECTION("diagonals as far as they are") {
    const double excess = ((1 - 0.3) * 4 + (1 - 0.3 * std::sqrt(2)) * 4) / 8;
    const Flattened after = flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 1});
    CHECK(after.given(2, 2) == Approx(excess));
    CHECK(after.field.snow(2, 2) == Approx(1 - excess));
    for (const Offset& step : kNeighbors) CHECK(after.field.snow(2 + step.z, 2 + step.x) == Approx(excess / 8));
    CHECK(after.field.snow(0, 0) == 0);
    CHECK(after.given.sum() == Approx(excess));
  }
  SECTION("the thesis's diagonals, and half of it moved") {
    const Flattened after = flatten(field, open_sky(field), {0.6, Diagonal::thesis, 0.5});
    CHECK(after.given(2, 2) == Approx(0.35));
    CHECK(after.field.snow(1, 1) == Approx(0.35 / 8));
  }
  SECTION("not more than there is") {
    field.ground(2, 2) = 3;
    const Flattened after = flatten(field, open_sky(field), {0.6, Diagonal::thesis, 1});
    CHECK(after.given(2, 2) == 1);
    CHECK(after.field.snow(2, 2) == 0);
    CHECK(after.field.snow(3, 2) == Approx(0.125));
  }
}

TEST_CASE("lower neighbours that are not too steep receive too, level, higher and blocked ones do not") {
  // One row: heights 0.9, 1, 0 and the last column's body in the way.
  Field field = flat_field(1, 3, 1, 0, 100);
  field.snow << 0.9, 1, 0;
  Flattened after = flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 1});
  CHECK(after.given(0, 1) == Approx(0.4));  // one steep side: c = 0.4, n = 1, m = 2
  CHECK(after.field.snow(0, 0) == Approx(1.1));
  CHECK(after.field.snow(0, 2) == Approx(0.2));
  CHECK(after.given(0, 0) == 0);

  Cells body = open_sky(field);
  body(0, 2) = 1;  // its underside at the snow's height: in the way
  after = flatten(field, body, {0.6, Diagonal::euclidean, 1});
  CHECK(after.given.maxCoeff() == 0);
  body(0, 2) = 1.001;
  CHECK(flatten(field, body, {0.6, Diagonal::euclidean, 1}).given(0, 1) == Approx(0.4));
  field.snow << 1, 1, 0;
  CHECK(flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 1}).field.snow(0, 2) == Approx(0.4));
}

TEST_CASE("receivers gain height by the ratio of densities, bare ground takes the giver's density") {
  Field field = flat_field(1, 3, 1, 0, 100);
  field.snow << 0.1, 2, 0;
  field.density << 400, 200, 50;
  const Flattened after = flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 1});
  const double given = ((1.9 - 0.6) + (2 - 0.6)) / 2;
  CHECK(after.given(0, 1) == Approx(given));
  CHECK(after.field.snow(0, 0) == Approx(0.1 + given / 2 * 200 / 400));
  CHECK(after.field.density(0, 0) == 400);
  CHECK(after.field.snow(0, 2) == Approx(given / 2));
  CHECK(after.field.density(0, 2) == Approx(200));
}

TEST_CASE("flattening keeps the mass and never leaves negative snow") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  Field field = random_field(random, 25, 20, 0.1);
  for (int i = 0; i < 30; ++i) field.snow(random.integer(0, 24), random.integer(0, 19)) = 0;
  Underside bodies = nothing_above(25, 20);
  add_ball(bodies, field, 0, {field.origin.x() + 1, 0.4, field.origin.y() + 1}, 0.5);
  const double before = mass(field);
  for (int i = 0; i < 100; ++i) {
    field = flatten(field, bodies.height, {0.6, Diagonal::euclidean, 0.5}).field;
    CHECK(field.snow.minCoeff() >= 0);
  }
  CHECK(mass(field) == Approx(before).epsilon(1e-12));
}

TEST_CASE("a pile flattens, the same on all sides, until no slope is too steep") {
  Field field = flat_field(41, 41, 0.1, 0, 100);
  field.snow.block(18, 18, 5, 5).setConstant(1.5);
  int iterations = 0;
  double moved = 1;
  for (; iterations < 5000 && moved > 1e-5; ++iterations) {
    const Flattened after = flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 0.5, 1e-9});
    moved = after.given.maxCoeff();
    field = after.field;
  }
  CAPTURE(iterations, moved);
  CHECK(worst_excess(field, 0.6) < 1e-3);
  CHECK(field.snow.maxCoeff() < 1.5);
  CHECK((field.snow - field.snow.transpose()).abs().maxCoeff() < 1e-12);
  CHECK((field.snow - field.snow.rowwise().reverse()).abs().maxCoeff() < 1e-12);
}

TEST_CASE("heights within the tie are level with each other") {
  Field field = flat_field(1, 3, 1, 0, 100);
  field.snow << 0.999, 1, 0;
  CHECK(flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 1, 0}).field.snow(0, 0) == Approx(0.999 + 0.2));
  CHECK(flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 1, 0.01}).field.snow(0, 0) == 0.999);
}

TEST_CASE("slopes that stand are left alone") {
  Field field = flat_field(6, 6, 0.5, 0, 100);
  for (int z = 0; z < 6; ++z) {
    for (int x = 0; x < 6; ++x) field.snow(z, x) = 0.29 * x + 0.02 * z;
  }
  CHECK(flatten(field, open_sky(field), {0.6, Diagonal::euclidean, 1}).given.maxCoeff() == 0);
  CHECK(flatten(field, open_sky(field), {0.5, Diagonal::euclidean, 1}).given.maxCoeff() > 0);
}
