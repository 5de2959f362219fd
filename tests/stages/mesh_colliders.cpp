// Meshes as colliders of particles: as the shapes they are meshes of.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stages/body_distance.h"
#include "tests/catch.h"
#include "tests/graph/folder.h"
#include "tests/stages/simulation.h"

using namespace firn::test;

namespace {

// A cube of this edge about the origin.
std::string cube_obj(double edge) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string((i & 1 ? 0.5 : -0.5) * edge) + " " + std::to_string((i & 2 ? 0.5 : -0.5) * edge) + " " +
            std::to_string((i & 4 ? 0.5 : -0.5) * edge) + "\n";
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

std::string scene_with(const std::string& shape, const std::string& motion) {
  return "firn: 1\ntime: {dt: 1.0e-4, fps: 30, end: 1}\ngravity: [0, 0, 0]\ndomain: {min: [-1, -1, -1], max: [1, 1, 1], cell: "
         "0.05}\n"
         "materials: {m: {preset: packed}}\nsnow:\n  - {box: {center: [0, 0, 0], size: [1.2, 1.2, 1.2]}, material: m, velocity: "
         "[3, -2, 1], per_cell: 8}\n"
         "bodies:\n  - {" +
         shape + ", friction: 0.3, " + motion + "}\n";
}

}  // namespace

TEST_CASE("particles meet a mesh as they meet the box it is a mesh of, standing, moving and turning") {
  const std::string motion =
      GENERATE("position: [0.05, 0.1, -0.05]",
               "position: [0.1, 0, 0], velocity: [4, 1, 0], spin: [0, 3, 1], orientation: {axis: [1, 2, 3], degrees: 40}",
               "mass: 3, position: [0.1, 0, 0], velocity: [4, 1, 0], orientation: {axis: [1, 2, 3], degrees: 40}");
  INFO(motion);
  Folder folder;
  const std::string file = folder.write("cube.obj", cube_obj(0.8)).string();
  const auto velocities = [&](const std::string& shape, std::vector<bool>& plain) {
    Simulation simulation("mpm_thesis", scene_with(shape, motion));
    // Where two faces are about as near, the mesh's grid has a normal between theirs, and nodes pass it on.
    const firn::scene::Body& body = simulation.loaded.problem->scene.bodies.front();
    plain.clear();
    for (const Vector3d& position : simulation.vectors("position")) {
      Vector3d own = (body.orientation.conjugate() * (position - body.position)).cwiseAbs();
      std::sort(own.begin(), own.end());
      plain.push_back(own[2] - own[1] > 0.14);
    }
    simulation.steps(1);
    return simulation.vectors("velocity");
  };
  std::vector<bool> plain;
  const std::vector<Vector3d> box = velocities("box: {size: [0.8, 0.8, 0.8]}", plain);
  const std::vector<Vector3d> mesh = velocities("mesh: {file: " + file + "}", plain);
  const std::vector<Vector3d> free = velocities("sphere: {radius: 0.001}", plain);
  REQUIRE(box.size() == mesh.size());
  std::size_t struck = 0, differ = 0;
  for (std::size_t p = 0; p < box.size(); ++p) {
    if (!plain[p] || (box[p] - free[p]).norm() < 0.1) continue;
    ++struck;
    if ((box[p] - mesh[p]).norm() > 0.05) ++differ;
  }
  INFO(struck << " struck, " << differ << " differ");
  CHECK(struck > 1000);
  CHECK(differ < struck / 50);
}

TEST_CASE("distances of a ball's mesh are those of the ball, to a part of a cell") {
  firn::scene::TriangleMesh mesh;
  const int rings = 24, around = 48;
  const double radius = 0.4;
  mesh.points.emplace_back(0, -radius, 0);
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double v = std::numbers::pi * i / rings, u = 2 * std::numbers::pi * j / around;
      mesh.points.emplace_back(radius * std::sin(v) * std::cos(u), -radius * std::cos(v), radius * std::sin(v) * std::sin(u));
    }
  const int top = static_cast<int>(mesh.points.size());
  mesh.points.emplace_back(0, radius, 0);
  const auto at = [&](int i, int j) { return 1 + (i - 1) * around + j % around; };
  for (int j = 0; j < around; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    mesh.triangles.push_back({at(rings - 1, j), top, at(rings - 1, j + 1)});
  }
  const firn::stages::DistanceGrid grid = firn::stages::distance_grid(mesh, 0.05);
  const std::vector<float> values = firn::stages::distances(mesh, grid);
  REQUIRE(values.size() == grid.count());
  CHECK(grid.cell == Approx(0.025));
  double worst = 0;
  for (int z = 0, n = 0; z < grid.nodes.z(); ++z)
    for (int y = 0; y < grid.nodes.y(); ++y)
      for (int x = 0; x < grid.nodes.x(); ++x, ++n) {
        const double exact = (grid.min + grid.cell * Eigen::Vector3d(x, y, z)).norm() - radius;
        worst = std::max(worst, std::abs(exact - static_cast<double>(values[static_cast<std::size_t>(n)])));
      }
  CHECK(worst < 0.005);
  CHECK((grid.min + grid.cell * (grid.nodes.cast<double>() - Eigen::Vector3d::Ones())).minCoeff() > radius + grid.cell);
}
