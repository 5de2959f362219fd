#include "tests/reference/collision.h"

#include "tests/catch.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {
Collider collider(Shape shape, Random& random) {
  Collider c;
  c.shape = shape;
  c.position = random.vector();
  c.orientation = random.orientation();
  c.normal = random.direction();
  c.half_size = Vector3d(random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1));
  c.radius = random.uniform(0.2, 1);
  c.velocity = random.vector();
  c.spin = random.vector(3);
  c.friction = random.uniform(0, 1);
  return c;
}

Collider ground(double friction, double angle = 0) {
  Collider c;
  c.normal = Vector3d(std::sin(angle), std::cos(angle), 0);  // falls off towards +x
  c.friction = friction;
  return c;
}
}  // namespace

TEST_CASE("signed distances of points whose distance is known") {
  Collider c;
  c.position = {1, 2, 3};
  c.half_size = {1, 2, 3};
  c.radius = 0.5;
  SECTION("plane") {
    CHECK(distance(c, {7, 2.5, -4}).signed_distance == Approx(0.5));
    CHECK(distance(c, {7, 1.5, -4}).signed_distance == Approx(-0.5));
    CHECK(distance(c, {7, 1.5, -4}).normal == Vector3d(0, 1, 0));
  }
  SECTION("sphere") {
    c.shape = Shape::sphere;
    CHECK(distance(c, {1, 2, 4}).signed_distance == Approx(0.5));
    CHECK(distance(c, {1, 1.75, 3}).signed_distance == Approx(-0.25));
    CHECK((distance(c, {1, 1.75, 3}).normal - Vector3d(0, -1, 0)).norm() < 1e-15);
    CHECK(distance(c, {1, 2, 3}).signed_distance == Approx(-0.5));
    CHECK(distance(c, {1, 2, 3}).normal.norm() == Approx(1));
  }
  SECTION("box") {
    c.shape = Shape::box;
    CHECK(distance(c, {1, 2, 3}).signed_distance == Approx(-1));
    CHECK(distance(c, {1.75, 2, 3}).signed_distance == Approx(-0.25));
    CHECK(distance(c, {1.75, 2, 3}).normal == Vector3d(1, 0, 0));
    CHECK(distance(c, {0.25, 2, 3}).normal == Vector3d(-1, 0, 0));
    CHECK(distance(c, {1.5, 2, 0.1}).normal == Vector3d(0, 0, -1));
    CHECK(distance(c, {1.5, 2, 0.1}).signed_distance == Approx(-0.1));
    CHECK(distance(c, {1.5, 4.5, 3}).signed_distance == Approx(0.5));
    CHECK(distance(c, {1.5, 4.5, 3}).normal == Vector3d(0, 1, 0));
    CHECK(distance(c, {5, -3, 3}).signed_distance == Approx(std::hypot(3, 3)));
    CHECK((distance(c, {5, -3, 3}).normal - Vector3d(1, -1, 0).normalized()).norm() < 1e-15);
  }
  SECTION("capsule") {
    c.shape = Shape::capsule;
    CHECK(distance(c, {2, 3.9, 3}).signed_distance == Approx(0.5));
    CHECK(distance(c, {1, 5, 3}).signed_distance == Approx(0.5));
    CHECK(distance(c, {1, 4.25, 3}).signed_distance == Approx(-0.25));
    CHECK(distance(c, {1, -3, 7}).signed_distance == Approx(std::hypot(3, 4) - 0.5));
  }
}

TEST_CASE("the normal is the gradient of the distance, and leads to the surface") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Shape shape = GENERATE(Shape::plane, Shape::sphere, Shape::box, Shape::capsule);
  for (int trial = 0; trial < 100; ++trial) {
    const Collider c = collider(shape, random);
    const Vector3d point = c.position + random.vector(1.5);
    const Distance d = distance(c, point);
    CHECK(d.normal.norm() == Approx(1));
    CHECK(std::abs(distance(c, point - d.signed_distance * d.normal).signed_distance) < 1e-12);
    const double e = 1e-7;
    // Near the middle planes of a box or the axis of a capsule the gradient jumps.
    if (shape == Shape::box && d.signed_distance < 0) {
      const Vector3d excess = (c.orientation.conjugate() * (point - c.position)).cwiseAbs() - c.half_size;
      int near = 0;
      for (int axis = 0; axis < 3; ++axis) near += excess[axis] > d.signed_distance - 1e-5 ? 1 : 0;
      if (near > 1) continue;
    }
    Vector3d numeric;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d shift = e * Vector3d::Unit(axis);
      numeric[axis] = (distance(c, point + shift).signed_distance - distance(c, point - shift).signed_distance) / (2 * e);
    }
    CHECK((numeric - d.normal).norm() < 1e-4);
  }
}

TEST_CASE("distances move and turn with the collider") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Shape shape = GENERATE(Shape::plane, Shape::sphere, Shape::box, Shape::capsule);
  const Collider c = collider(shape, random);
  const Vector3d point = c.position + random.vector(1.5);
  const Eigen::Quaterniond turn = random.orientation();
  const Vector3d shift = random.vector();
  Collider moved = c;
  moved.position = turn * c.position + shift;
  moved.orientation = turn * c.orientation;
  const Distance before = distance(c, point), after = distance(moved, turn * point + shift);
  CHECK(after.signed_distance == Approx(before.signed_distance).margin(1e-13));
  CHECK((after.normal - turn * before.normal).norm() < 1e-12);
}

TEST_CASE("friction obeys Coulomb: contact sticks up to mu times the normal speed and slides beyond") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  int stuck = 0, slid = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Collider c = collider(Shape::sphere, random);
    const Vector3d point = c.position + 0.9 * c.radius * random.direction();
    const Vector3d n = distance(c, point).normal;
    const Vector3d v_c = c.velocity + c.spin.cross(point - c.position);
    const Vector3d v = random.vector(3);
    const Vector3d before = v - v_c, after = collide(v, point, c) - v_c;
    const double push = -before.dot(n);
    const Vector3d v_t = before + push * n;
    if (push <= 0) {
      CHECK(collide(v, point, c) == v);  // leaving: untouched
    } else if (v_t.norm() <= c.friction * push) {
      ++stuck;
      CHECK(after.norm() < 1e-13);
    } else {
      ++slid;
      CHECK(std::abs(after.dot(n)) < 1e-13);
      CHECK(after.norm() == Approx(v_t.norm() - c.friction * push));
      CHECK(after.cross(v_t).norm() < 1e-12);
      CHECK(after.dot(v_t) > 0);
    }
  }
  CHECK(stuck > 10);
  CHECK(slid > 10);
}

TEST_CASE("contact is the same for an observer who moves along") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 50; ++trial) {
    const Collider c = collider(Shape::box, random);
    Collider moving = c;
    const Vector3d wind = random.vector(5), v = random.vector(3), point = c.position + random.vector(0.2);
    moving.velocity += wind;
    CHECK((collide(v + wind, point, moving) - collide(v, point, c) - wind).norm() < 1e-12);
  }
}

TEST_CASE("a point outside is left alone, a point on the surface is in contact") {
  const Vector3d v(1, -2, 3);
  CHECK(collide(v, {0, 1e-9, 0}, ground(0)) == v);
  CHECK(collide(v, {0, 0, 0}, ground(0)) == Vector3d(1, 0, 3));
  CHECK(collide(v, {0, -1, 0}, ground(100)) == Vector3d(0, 0, 0));
}

TEST_CASE("several colliders act in their order") {
  Collider wall;
  wall.normal = {1, 0, 0};
  wall.velocity = {2, 5, 0};
  wall.friction = 10;  // takes along what touches it
  CHECK(collide({-1, -1, 0}, {0, 0, 0}, {wall, ground(0)}) == Vector3d(2, 5, 0));
  CHECK(collide({-1, -1, 0}, {0, 0, 0}, {ground(0), wall}) == Vector3d(2, 5, 0));
  wall.velocity = {2, -5, 0};
  CHECK(collide({-1, -1, 0}, {0, 0, 0}, {wall, ground(0)}) == Vector3d(2, 0, 0));
  CHECK(collide({-1, -1, 0}, {0, 0, 0}, {ground(0), wall}) == Vector3d(2, -5, 0));
}

TEST_CASE("a block on a slope slides with g (sin a - mu cos a), and rests when mu >= tan a") {
  const double a = 0.5, g = 9.81, dt = 1e-3;
  for (const double mu : {0.0, 0.2, 0.5, std::tan(a) + 1e-9, 0.8}) {
    CAPTURE(mu);
    Particles block;
    block.add({0, 0, 0}, {0, 0, 0}, 1, 1);
    std::vector<Collider> slope{ground(mu, a)};
    for (int i = 0; i < 1000; ++i) {
      block.position[0] -= 1e-9 * slope[0].normal;  // rounding must not lift it off
      block.velocity[0] += dt * Vector3d(0, -g, 0);
      particle_collide(block, slope);
      block.position[0] += dt * block.velocity[0];
    }
    const Vector3d down(std::cos(a), -std::sin(a), 0);
    const double acceleration = std::max(0.0, g * (std::sin(a) - mu * std::cos(a)));
    CHECK((block.velocity[0] - acceleration * 1.0 * down).norm() < 1e-9);
    CHECK(block.position[0].dot(down) == Approx(acceleration * dt * dt * 1000 * 1001 / 2).margin(1e-9));
  }
}

TEST_CASE("colliders advance by their velocity and turn by their spin") {
  Collider c;
  c.velocity = {1, 2, 3};
  c.spin = {0, std::acos(0.0), 0};
  std::vector<Collider> all{c, Collider{}};
  for (int i = 0; i < 100; ++i) advance(all, 0.01);
  CHECK((all[0].position - Vector3d(1, 2, 3)).norm() < 1e-13);
  CHECK((all[0].orientation * Vector3d(1, 0, 0) - Vector3d(0, 0, -1)).norm() < 1e-12);  // a quarter turn about +y
  CHECK(all[1].position == Vector3d(0, 0, 0));
  // The surface moves as velocity_at says.
  Collider turning = c;
  const Vector3d arm(0.3, -0.2, 0.7);
  const Vector3d v = velocity_at(turning, turning.position + arm);
  std::vector<Collider> one{turning};
  advance(one, 1e-6);
  CHECK(((one[0].position + one[0].orientation * arm - turning.position - arm) / 1e-6 - v).norm() < 1e-5);
}
