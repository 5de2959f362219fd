// The underside that is drawn, against rays cast straight up from every cell in double precision.

#include "tests/stages/field_simulation.h"

using namespace firn::test;
using Eigen::Quaterniond;
using Eigen::Vector2d;

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

struct Solid {
  std::string kind;  // sphere, box, capsule, mesh
  Vector3d position;
  Quaterniond orientation;
  Vector3d size;  // sphere: radius; box: half edges; capsule: radius, half length of its axis (local x)
  std::vector<Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
};

double under_ball(const Vector3d& center, double radius, const Vector2d& at) {
  const double rest = radius * radius - (at - Vector2d(center.x(), center.z())).squaredNorm();
  return rest > 0 ? center.y() - std::sqrt(rest) : none;
}

double under_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector2d& at) {
  Eigen::Matrix3d m;
  m << a.x(), b.x(), c.x(), a.z(), b.z(), c.z(), 1, 1, 1;
  if (std::abs(m.determinant()) < 1e-12) return none;
  const Vector3d share = m.inverse() * Vector3d(at.x(), at.y(), 1);
  return share.minCoeff() >= 0 ? share.dot(Vector3d(a.y(), b.y(), c.y())) : none;
}

double lowest(const Solid& s, const Vector2d& at) {
  const auto world = [&](const Vector3d& own) -> Vector3d { return s.position + s.orientation * own; };
  double result = none;
  if (s.kind == "sphere") return under_ball(s.position, s.size.x(), at);
  if (s.kind == "capsule") {
    constexpr int balls = 1500;
    for (int i = 0; i <= balls; ++i)
      result = std::min(result, under_ball(world(Vector3d((2.0 * i / balls - 1) * s.size.y(), 0, 0)), s.size.x(), at));
    return result;
  }
  if (s.kind == "box") {
    // From below: the farthest entry of the three slabs.
    const Vector3d from = s.orientation.conjugate() * (Vector3d(at.x(), -100, at.y()) - s.position);
    const Vector3d way = s.orientation.conjugate() * Vector3d(0, 1, 0);
    double enter = -none, leave = none;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(way[axis]) < 1e-14) {
        if (std::abs(from[axis]) > s.size[axis]) return none;
        continue;
      }
      const double one = (-s.size[axis] - from[axis]) / way[axis], two = (s.size[axis] - from[axis]) / way[axis];
      enter = std::max(enter, std::min(one, two));
      leave = std::min(leave, std::max(one, two));
    }
    return enter <= leave ? enter - 100 : none;
  }
  for (const auto& t : s.triangles)
    result = std::min(
        result, under_triangle(world(s.points[static_cast<std::size_t>(t[0])]), world(s.points[static_cast<std::size_t>(t[1])]),
                               world(s.points[static_cast<std::size_t>(t[2])]), at));
  return result;
}

std::string pose(const Vector3d& p, const Quaterniond& q) {
  return fmt::format("position: [{}, {}, {}], orientation: [{}, {}, {}, {}]", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

// A closed pyramid with a random top and bottom.
std::string pyramid_file(firn::reference::Random& random, Solid& solid) {
  for (const auto& [x, z] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    solid.points.emplace_back(x * random.uniform(0.3, 0.8), random.uniform(-0.1, 0.1), z * random.uniform(0.3, 0.8));
  solid.points.emplace_back(random.uniform(-0.2, 0.2), -0.6, random.uniform(-0.2, 0.2));
  solid.points.emplace_back(random.uniform(-0.2, 0.2), 0.4, random.uniform(-0.2, 0.2));
  for (int side = 0; side < 4; ++side) {
    solid.triangles.push_back({side, (side + 1) % 4, 4});
    solid.triangles.push_back({(side + 1) % 4, side, 5});
  }
  const auto file = std::filesystem::temp_directory_path() / ("firn-pyramid-" + std::to_string(getpid()) + ".obj");
  std::ofstream out(file);
  out.precision(17);
  for (const Vector3d& p : solid.points) out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const auto& t : solid.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return file.string();
}

}  // namespace

TEST_CASE("the underside of spheres, boxes, capsules and meshes is where rays from below meet them, and tells whose it is") {
  INFO("seed " << seed());
  firn::reference::Random random(seed());
  std::vector<Solid> solids;
  std::string bodies, mesh;
  const char* kinds[] = {"sphere", "box", "capsule", "mesh"};
  for (int b = 0; b < 12; ++b) {
    Solid s{kinds[b % 4],
            {random.uniform(-0.5, 8.5), random.uniform(0.5, 2), random.uniform(-0.5, 6.5)},
            random.orientation().normalized(),
            Vector3d(random.uniform(0.2, 0.7), random.uniform(0.2, 0.7), random.uniform(0.2, 0.7)),
            {},
            {}};
    std::string shape;
    if (s.kind == "sphere") shape = fmt::format("sphere: {{radius: {}}}", s.size.x());
    if (s.kind == "box") shape = fmt::format("box: {{size: [{}, {}, {}]}}", 2 * s.size.x(), 2 * s.size.y(), 2 * s.size.z());
    if (s.kind == "capsule")
      shape = fmt::format("capsule: {{from: [{}, 0, 0], to: [{}, 0, 0], radius: {}}}", -s.size.y(), s.size.y(), s.size.x());
    if (s.kind == "mesh") {
      mesh = pyramid_file(random, s);  // one file: the last one is meant by all
      for (Solid& other : solids)
        if (other.kind == "mesh") other.points = s.points;
      shape = fmt::format("mesh: {{file: {}}}", mesh);
    }
    // Every second one has a mass: a mesh then lies about its centre of mass, along its principal axes. So has one of the boxes,
    // which might turn.
    bodies += fmt::format("  - {{{}, {}{}}}\n", shape, pose(s.position, s.orientation),
                          b % 2 == 0 || b == 3 || b == 5 ? ", mass: 10" : "");
    solids.push_back(s);
  }
  Simulation simulation(
      "heightfield_contour",
      "firn: 1\nname: rays\ngravity: [0, 0, 0]\ntime: {dt: 1.0e-3, end: 1}\nfield: {size: [8, 6], cells: [80, 60], depth: 0.3, "
      "material: new_snow}\nbodies:\n" +
          bodies);
  std::filesystem::remove(mesh);
  simulation.steps(1);
  const std::vector<float> underside = simulation.floats("underside");
  const std::vector<float> owner_bits = simulation.floats("owner");
  int covered = 0;
  for (int z = 0; z < 60; ++z)
    for (int x = 0; x < 80; ++x) {
      const auto at = [&](double dx, double dz, int* who) {
        double least = none;
        for (std::size_t b = 0; b < solids.size(); ++b) {
          const double y = lowest(solids[b], Vector2d((x + 0.5 + dx) * 0.1, (z + 0.5 + dz) * 0.1));
          if (y < least && who != nullptr) *who = static_cast<int>(b);
          least = std::min(least, y);
        }
        return least;
      };
      int who = -1;
      const double expected = at(0, 0, &who);
      // A hair beside an outline the drawing may decide otherwise.
      bool beside_an_edge = false;
      double rise = 0;  // over a hundredth of a cell
      for (const auto& [dx, dz] : {std::pair{0.01, 0.0}, {-0.01, 0.0}, {0.0, 0.01}, {0.0, -0.01}}) {
        int other = -1;
        const double near = at(dx, dz, &other);
        beside_an_edge = beside_an_edge || other != who || (std::isfinite(near) && std::abs(near - expected) > 0.01);
        if (std::isfinite(near)) rise = std::max(rise, std::abs(near - expected));
      }
      if (beside_an_edge) continue;
      const std::size_t i = static_cast<std::size_t>(z * 80 + x);
      CAPTURE(x, z, who);
      CHECK(std::bit_cast<std::int32_t>(owner_bits[i]) == who);
      if (who < 0) {
        CHECK(std::isinf(underside[i]));
      } else {
        ++covered;
        // Devices put corners on a raster of 1/256 of a pixel at least: on steep faces that is a difference in height.
        CHECK(static_cast<double>(underside[i]) == Approx(expected).epsilon(1e-5).margin(2e-5 + 100 * rise / 256));
      }
    }
  CHECK(covered > 300);
}

TEST_CASE("the underside of a moving body is the lowest of all places on its way through the step") {
  INFO("seed " << seed());
  firn::reference::Random random(seed());
  const char* shapes[] = {"sphere: {radius: 0.4}", "box: {size: [0.8, 0.5, 0.6]}",
                          "capsule: {from: [-0.4, 0, 0], to: [0.4, 0, 0], radius: 0.25}"};
  for (int kind = 0; kind < 3; ++kind) {
    CAPTURE(shapes[kind]);
    const Vector3d from(2, 1.2, 2), velocity(random.uniform(10, 20), random.uniform(-3, 3), random.uniform(-8, 8));
    const Quaterniond turn = random.orientation().normalized();
    Simulation simulation("heightfield_contour",
                          fmt::format("firn: 1\nname: sweep\ngravity: [0, 0, 0]\ntime: {{dt: 0.1, end: 1}}\nfield: {{size: [8, 6], "
                                      "cells: [80, 60], depth: 0.3, "
                                      "material: new_snow}}\nbodies: [{{{}, {}, velocity: [{}, {}, {}]}}]\n",
                                      shapes[kind], pose(from, turn), velocity.x(), velocity.y(), velocity.z()));
    simulation.steps(2);
    const std::vector<float> underside = simulation.floats("underside");
    Solid s{kind == 0   ? "sphere"
            : kind == 1 ? "box"
                        : "capsule",
            from,
            turn,
            kind == 0   ? Vector3d(0.4, 0, 0)
            : kind == 1 ? Vector3d(0.4, 0.25, 0.3)
                        : Vector3d(0.25, 0.4, 0),
            {},
            {}};
    int covered = 0;
    for (int z = 0; z < 60; z += 3)
      for (int x = 0; x < 80; x += 3) {
        double expected = none;
        for (int i = 0; i <= 2000; ++i) {
          s.position = from + velocity * 0.1 * i / 2000;
          const Vector2d at((x + 0.5) * 0.1, (z + 0.5) * 0.1);
          expected = std::min(expected, lowest(s, at));
        }
        const double drawn = static_cast<double>(underside[static_cast<std::size_t>(z * 80 + x)]);
        CAPTURE(x, z);
        if (std::isfinite(expected)) {
          ++covered;
          // The samples lie above the true envelope by up to a step's way.
          CHECK(drawn <= expected + 1e-4);
          CHECK(drawn >= expected - 0.03);
        }
      }
    CHECK(covered > 5);
  }
}

// An upright box that slides: the least height is that of its bottom, or above a tilted way that of the way; nothing is left out.
TEST_CASE("a box that keeps its orientation covers every cell on its way, whichever edges and ways lie in one plane") {
  struct Case {
    Vector3d velocity;
    bool turned;
  };
  INFO("seed " << seed());
  firn::reference::Random random(seed());
  const double v = random.uniform(8, 12);
  for (const Case& one :
       {Case{{0, 0, 0}, false}, Case{{v, 0, 0}, false}, Case{{0, v, 0}, false}, Case{{0, 0, -v}, false}, Case{{v, 0, v}, false},
        Case{{-v, 0, 0.5 * v}, true}, Case{{0, -v, 0}, true}, Case{{v, -0.5 * v, 0}, false}}) {
    CAPTURE(one.velocity.transpose(), one.turned);
    const Vector3d from(4, 2, 3), half(0.4, 0.25, 0.3);
    const Quaterniond turn =
        one.turned ? Quaterniond(Eigen::AngleAxisd(random.uniform(0.1, 0.7), Vector3d::UnitY())) : Quaterniond::Identity();
    Simulation simulation("heightfield_contour",
                          fmt::format("firn: 1\nname: slide\ngravity: [0, 0, 0]\ntime: {{dt: 0.1, end: 1}}\nfield: {{size: [8, 6], "
                                      "cells: [320, 240], depth: 0.3, material: new_snow}}\n"
                                      "bodies: [{{box: {{size: [0.8, 0.5, 0.6]}}, {}, velocity: [{}, {}, {}]}}]\n",
                                      pose(from, turn), one.velocity.x(), one.velocity.y(), one.velocity.z()));
    simulation.steps(2);
    const std::vector<float> underside = simulation.floats("underside");
    int covered = 0;
    for (int z = 0; z < 240; ++z)
      for (int x = 0; x < 320; ++x) {
        // In the box's axes, seen from above: for which parts of the way the cell lies in the rectangle, by its two slabs.
        const Vector3d at = turn.conjugate() * (Vector3d((x + 0.5) * 0.025, 0, (z + 0.5) * 0.025) - from);
        const Vector3d way = turn.conjugate() * (one.velocity * 0.1);
        double first = 0, last = 1, slack = none;
        for (const int axis : {0, 2}) {
          if (std::abs(way[axis]) < 1e-9) {
            slack = std::min(slack, half[axis] - std::abs(at[axis]));
            continue;
          }
          const double one_end = (at[axis] - half[axis]) / way[axis], other_end = (at[axis] + half[axis]) / way[axis];
          first = std::max(first, std::min(one_end, other_end));
          last = std::min(last, std::max(one_end, other_end));
        }
        slack = std::min(slack, (last - first) * 0.5);
        if (std::abs(slack) < 0.003) continue;  // an outline may be drawn either way
        CAPTURE(x, z);
        const float drawn = underside[static_cast<std::size_t>(z * 320 + x)];
        if (slack < 0) {
          CHECK(std::isinf(drawn));
          continue;
        }
        ++covered;
        const double lowest_y = from.y() - half.y() + way.y() * (way.y() < 0 ? last : first);
        CHECK(static_cast<double>(drawn) == Approx(lowest_y).margin(1e-4 + std::abs(way.y()) / 100));
      }
    CHECK(covered > 700);
  }
}
