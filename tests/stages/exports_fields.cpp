// The grid of the particles and the height field, as files.

#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "scene/image.h"
#include "stages/node_field.h"
#include "tests/stages/export_shot.h"

using namespace firn::test;
namespace fs = std::filesystem;

TEST_CASE("the grid has the mass and the momentum of the particles, where they are") {
  Folder folder;
  Strained shot("[render.background, {io.grid: {format: vti}}]", folder.path());
  write_frames(shot, 1);
  const VtkFile file = read_vtk(folder.path() / "export" / "grid_0000.vti");
  const std::vector<double> density = file.arrays.at("density"), velocity = file.arrays.at("velocity");
  const std::vector<float> mass = shot.read("mass"), position = shot.read("position"), own = shot.read("velocity");
  int e[6];
  REQUIRE(std::sscanf(file.attribute("Piece", "Extent").c_str(), "%d %d %d %d %d %d", e, e + 1, e + 2, e + 3, e + 4, e + 5) == 6);
  CHECK(file.attribute("ImageData", "Origin") == "-1 -1 -1");
  CHECK(bytes_of(folder.path() / "export" / "grid.vti.series").find("grid_0000.vti") != std::string::npos);
  CHECK(file.attribute("ImageData", "Spacing") == "0.05 0.05 0.05");
  CHECK(file.attribute("ImageData", "WholeExtent") == file.attribute("Piece", "Extent"));
  REQUIRE(density.size() == static_cast<std::size_t>((e[1] - e[0] + 1) * (e[3] - e[2] + 1) * (e[5] - e[4] + 1)));
  // Sums of 1, of x and of v over the nodes: B-splines reproduce all of them.
  const double volume = 0.05 * 0.05 * 0.05;
  std::array<double, 7> of_nodes{}, of_particles{};
  std::size_t n = 0;
  for (int k = e[4]; k <= e[5]; ++k)
    for (int j = e[2]; j <= e[3]; ++j)
      for (int i = e[0]; i <= e[1]; ++i, ++n) {
        const double m = density[n] * volume;
        const int node[] = {i, j, k};
        of_nodes[0] += m;
        for (std::size_t a = 0; a < 3; ++a) {
          of_nodes[1 + a] += m * (-1 + 0.05 * node[a]);
          of_nodes[4 + a] += m * velocity[3 * n + a];
        }
      }
  for (std::size_t p = 0; p < mass.size(); ++p) {
    const double m = static_cast<double>(mass[p]);
    of_particles[0] += m;
    for (std::size_t a = 0; a < 3; ++a) {
      of_particles[1 + a] += m * static_cast<double>(position[3 * p + a]);
      of_particles[4 + a] += m * static_cast<double>(own[3 * p + a]);
    }
  }
  for (std::size_t i = 0; i < 7; ++i) CHECK(of_nodes[i] == Approx(of_particles[i]).epsilon(1e-5).margin(1e-6));
}

TEST_CASE("the height field comes back from vti, png and mesh") {
  Folder folder;
  const std::string scene =
      "firn: 1\nname: field\nfield: {size: [2, 1.5], origin: [1, -1], cells: [8, 6], ground: 0.25, depth: 0.5, material: "
      "new_snow}\n";
  Shot shot(scene, "[heightfield.init]",
            "[render.background, io.heightfield, {io.heightfield: {format: png, metres: 2}}, {io.heightfield: {format: obj}}, "
            "{io.heightfield: {format: ply}}]",
            small_image, folder.path().string());
  std::vector<float> depth = shot.read("depth");
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = 0.0301234f * static_cast<float>(i);
  shot.write("depth", depth);
  write_frames(shot, 1);
  const fs::path exports = folder.path() / "export";

  const VtkFile vti = read_vtk(exports / "heightfield_0000.vti");
  CHECK(vti.arrays.at("depth") == doubles(depth));
  CHECK(vti.arrays.at("density") == doubles(shot.read("density")));
  CHECK(bytes_of(exports / "heightfield.vti.series").find("heightfield_0000.vti") != std::string::npos);
  CHECK(vti.arrays.at("ground") == std::vector<double>(48, 0.25));
  CHECK(vti.attribute("Piece", "Extent") == "0 7 0 0 0 5");
  CHECK(vti.attribute("ImageData", "Origin") == "1.125 0 -0.875");
  CHECK(vti.attribute("ImageData", "Spacing") == "0.25 0.25 0.25");

  const firn::scene::GreyImage image = firn::scene::read_image((exports / "heightfield_0000.png").string());
  REQUIRE(image.width == 8);
  for (std::size_t i = 0; i < depth.size(); ++i) CHECK(2 * image.values[i] == Approx(static_cast<double>(depth[i])).margin(2e-5));

  const ObjFile obj = read_obj(exports / "heightfield_0000.obj");
  const PlyFile ply = read_ply(exports / "heightfield_0000.ply");
  REQUIRE(obj.points.size() == 48);
  CHECK(obj.faces.size() == 70);
  CHECK(ply.faces == obj.faces);
  for (std::size_t i = 0; i < 48; ++i) {
    const double x = 1.125 + 0.25 * static_cast<double>(i % 8), z = -0.875 + 0.25 * static_cast<double>(i / 8);
    CHECK(obj.points[i][0] == Approx(x));
    CHECK(obj.points[i][1] == Approx(0.25 + static_cast<double>(depth[i])).epsilon(1e-7));
    CHECK(obj.points[i][2] == Approx(z));
    CHECK(ply.columns.at("y")[i] == Approx(obj.points[i][1]));
  }
  for (const auto& f : obj.faces) {  // seen from above
    const auto &a = obj.points[static_cast<std::size_t>(f[0])], &b = obj.points[static_cast<std::size_t>(f[1])],
               &c = obj.points[static_cast<std::size_t>(f[2])];
    CHECK((b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]) > 0);
  }
}

TEST_CASE("a picture of the surface says what black and white are, keeps it, and ends in them") {
  Folder folder;
  const std::string scene =
      "firn: 1\nname: field\nfield: {size: [2, 1.5], origin: [1, -1], cells: [8, 6], ground: 3.25, depth: 0.5, material: "
      "new_snow}\n";
  Shot shot(scene, "[heightfield.init]", "[render.background, {io.heightfield: {format: png, picture: surface}}]", small_image,
            folder.path().string());
  std::vector<float> depth = shot.read("depth");
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = 0.01f * static_cast<float>(i);
  shot.write("depth", depth);
  shot.frame();
  std::vector<float> higher = depth;
  higher.back() = 5;  // far beyond
  shot.write("depth", higher);
  std::vector<float> lower = shot.read("ground");
  lower.front() = 1;  // below what is black
  shot.write("ground", lower);
  shot.frame();
  shot.execution().finish();
  // From 3.25 to 3.72 m: black is the whole metre below, white twice as far up as that needs, and a power of two.
  for (const char* name : {"heightfield_0000.png", "heightfield_0001.png"}) {
    CAPTURE(name);
    const fs::path file = folder.path() / "export" / name;
    const std::string bytes = bytes_of(file);
    CHECK(bytes.find(std::string("metres at black\0003", 17)) != std::string::npos);
    CHECK(bytes.find(std::string("metres at white\0005", 17)) != std::string::npos);
    const firn::scene::GreyImage image = firn::scene::read_image(file.string());
    REQUIRE(image.values.size() == depth.size());
    for (std::size_t i = 1; i + 1 < depth.size(); ++i)
      CHECK(3 + 2 * image.values[i] == Approx(3.25 + static_cast<double>(depth[i])).margin(2e-5));
  }
  CHECK(firn::scene::read_image((folder.path() / "export" / "heightfield_0001.png").string()).values.back() == 1);
  CHECK(firn::scene::read_image((folder.path() / "export" / "heightfield_0001.png").string()).values.front() == 0);
}

TEST_CASE("nodes before the first and at the last of the grid count, and particles that are nowhere do not") {
  const Eigen::Vector3d origin(0, 0, 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> position{-0.85f, 0.25f, 0.35f, 0.9f, 0.9f, 0.9f, nan, 0, 0}, velocity{1, 2, 3, 4, 5, 6, nan, nan, nan},
      mass{2, 3, 5};
  const firn::stages::NodeField field = firn::stages::node_field(position, velocity, mass, origin, 0.1);
  double whole = 0, center = 0;
  for (const firn::stages::NodeField::Block& block : field.blocks)
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
          const std::size_t n = firn::stages::NodeField::index(x, y, z);
          const double here = static_cast<double>(block.density[n]) * 1e-3;
          whole += here;
          center += here * 0.1 * (block.first[0] + x);
          CHECK(std::isfinite(block.velocity[n][0]));
        }
  CHECK(whole == Approx(5));
  CHECK(center == Approx(2 * -0.85 + 3 * 0.9));
  // The particle at 0.9 m reaches nodes 8, 9 and 10; the dense field has them up to 9: 7/8 of its mass along each axis.
  const firn::stages::DenseField dense = firn::stages::dense(field, {9, 9, 9});
  CHECK(std::accumulate(dense.density.begin(), dense.density.end(), 0.0) * 1e-3 == Approx(3 * std::pow(7.0 / 8, 3)));
}
