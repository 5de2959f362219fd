// Every exported file gives back the numbers that were on the device.

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "scene/image.h"
#include "stages/vdb_files.h"
#include "tests/catch.h"
#include "tests/small_disk.h"
#include "tests/stages/export_readers.h"
#include "tests/stages/render_shot.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

const std::string small_image = "64x36";
const std::string snow_setup = "[mpm.seed, bodies.place, {mpm.stress: {accumulate: float}}]";

// Snow under strain, so that no array is of one value.
struct Strained : Shot {
  Strained(const std::string& stages, const fs::path& output, const SceneText& scene = {})
      : Shot(scene.text(), snow_setup, stages, small_image, output.string()) {
    std::vector<float> velocity = read("velocity"), plastic = read("plastic_det"), stress = read("stress");
    for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] = 0.25f * static_cast<float>(i % 7) - 0.5f;
    for (std::size_t i = 0; i < plastic.size(); ++i) plastic[i] = 1 + 0.001f * static_cast<float>(i % 100);
    for (std::size_t i = 0; i < stress.size(); ++i) stress[i] = 0.01f * static_cast<float>(i % 11);
    write("velocity", velocity);
    write("plastic_det", plastic);
    write("stress", stress);
  }
};

std::vector<double> doubles(const std::vector<float>& values) { return {values.begin(), values.end()}; }

// Frobenius norms of V_p0 P FE^T over V_p0.
std::vector<double> norms(const Shot& shot) {
  const std::vector<float> stress = shot.read("stress"), volume = shot.read("volume");
  std::vector<double> result;
  for (std::size_t p = 0; p < volume.size(); ++p) {
    double sum = 0;
    for (std::size_t i = 0; i < 9; ++i) sum += std::pow(static_cast<double>(stress[9 * p + i]), 2);
    result.push_back(std::sqrt(sum) / static_cast<double>(volume[p]));
  }
  return result;
}

void check_near(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  double worst = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    worst = std::max(worst, std::abs(found[i] - expected[i]) / std::max(1.0, std::abs(expected[i])));
  CHECK(worst < 1e-6);
}

void write_frames(Shot& shot, int count) {
  for (int i = 0; i < count; ++i) {
    shot.execution().clock().time = 0.125 * i;
    shot.frame();
  }
  shot.execution().finish();
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<double> every(const std::vector<double>& values, std::size_t start, std::size_t step) {
  std::vector<double> picked;
  for (std::size_t i = start; i < values.size(); i += step) picked.push_back(values[i]);
  return picked;
}

}  // namespace

TEST_CASE("particles as vtp read back equal, with their time, as one vertex each") {
  Folder folder;
  const std::string compression = GENERATE("0", "1", "9");
  Strained shot("[render.background, {io.particles: {compression: " + compression + "}}]", folder.path());
  write_frames(shot, 2);
  const VtkFile file = read_vtk(folder.path() / "export" / "particles_0001.vtp");
  const std::vector<double> position = doubles(shot.read("position"));
  CHECK(file.attribute("Piece", "NumberOfPoints") == std::to_string(position.size() / 3));
  CHECK(file.attribute("Piece", "NumberOfVerts") == std::to_string(position.size() / 3));
  CHECK(file.arrays.at("position") == position);
  CHECK(file.arrays.at("velocity") == doubles(shot.read("velocity")));
  CHECK(file.components.at("velocity") == 3);
  CHECK(file.arrays.at("J_P") == doubles(shot.read("plastic_det")));
  check_near(file.arrays.at("stress_norm"), norms(shot));
  CHECK(file.arrays.at("material") == std::vector<double>(position.size() / 3, 0));
  CHECK(file.arrays.at("TimeValue") == std::vector<double>{0.125});
  CHECK(file.arrays.at("connectivity").back() == static_cast<double>(position.size() / 3 - 1));
  CHECK(file.arrays.at("offsets").back() == static_cast<double>(position.size() / 3));
}

TEST_CASE("data of many blocks, the last of them full or not, come back whole") {
  Folder folder;
  SceneText scene;
  scene.snow = "[0, 0.2, 0]";
  std::string text = scene.text();
  text.replace(text.find("radius: 0.1"), 11, "radius: 0.7");
  Shot shot(text, "[mpm.seed]", "[render.background, io.particles]", small_image, folder.path().string());
  write_frames(shot, 1);
  const VtkFile file = read_vtk(folder.path() / "export" / "particles_0000.vtp");
  CHECK(file.arrays.at("position").size() * 4 > 1 << 20);
  CHECK(file.arrays.at("position") == doubles(shot.read("position")));
  CHECK(file.arrays.count("stress_norm") == 0);  // nobody wrote a stress
}

TEST_CASE("the lists of a series name each file with its time, and forget what an earlier run left") {
  Folder folder;
  fs::create_directories(folder.path() / "export");
  folder.write("export/particles_0007.vtp", "old");
  folder.write("export/particles_notes.vtp", "mine");
  Strained shot("[render.background, io.particles]", folder.path());
  write_frames(shot, 2);
  CHECK(names_in(folder.path() / "export") == std::vector<std::string>{"particles.pvd", "particles.vtp.series",
                                                                       "particles_0000.vtp", "particles_0001.vtp",
                                                                       "particles_notes.vtp"});
  CHECK(bytes_of(folder.path() / "export" / "particles.vtp.series") ==
        "{\n  \"file-series-version\" : \"1.0\",\n  \"files\" : [\n    { \"name\" : \"particles_0000.vtp\", \"time\" : 0 },\n"
        "    { \"name\" : \"particles_0001.vtp\", \"time\" : 0.125 }\n  ]\n}\n");
  CHECK(bytes_of(folder.path() / "export" / "particles.pvd").find("timestep=\"0.125\" part=\"0\" file=\"particles_0001.vtp\"") !=
        std::string::npos);
}

TEST_CASE("times of a series are as short as twelve digits allow") {
  Folder folder;
  Shot shot(SceneText{}, "[render.background, io.particles]", small_image, folder.path().string());
  shot.execution().clock().time = 7000 * 1e-4;  // 0.7000000000000001
  shot.frame();
  shot.execution().finish();
  const fs::path exports = folder.path() / "export";
  CHECK(bytes_of(exports / "particles.pvd").find("timestep=\"0.7\"") != std::string::npos);
  CHECK(bytes_of(exports / "particles.vtp.series").find("\"time\" : 0.7 }") != std::string::npos);
  CHECK(bytes_of(exports / "particles_0000.vtp").find(">0.7</DataArray>") != std::string::npos);
}

TEST_CASE("a series that goes on from a later frame keeps what was before, with its times") {
  Folder folder;
  {
    Strained shot("[render.background, io.particles]", folder.path());
    write_frames(shot, 3);
  }
  Strained shot("[render.background, io.particles]", folder.path());
  shot.execution().clock().frame = 2;
  shot.execution().clock().time = 0.75;
  shot.frame();
  shot.execution().finish();
  const std::string series = bytes_of(folder.path() / "export" / "particles.vtp.series");
  CHECK(series.find("particles_0001.vtp\", \"time\" : 0.125 }") != std::string::npos);
  CHECK(series.find("particles_0002.vtp\", \"time\" : 0.75 }") != std::string::npos);
}

TEST_CASE("particles as ply and npy read back equal") {
  Folder folder;
  Strained shot("[render.background, {io.particles: {format: ply}}, {io.particles: {format: npy}}]", folder.path());
  write_frames(shot, 1);
  const std::vector<double> position = doubles(shot.read("position")), velocity = doubles(shot.read("velocity"));
  const PlyFile ply = read_ply(folder.path() / "export" / "particles_0000.ply");
  const NpyFile npy = read_npy_file(folder.path() / "export" / "particles_0000.npy");
  CHECK(npy.shape == std::vector<std::size_t>{position.size() / 3, 6});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(ply.columns.at(std::string(1, "xyz"[axis])) == every(position, axis, 3));
    CHECK(ply.columns.at(std::string("v") + "xyz"[axis]) == every(velocity, axis, 3));
    CHECK(every(npy.values, axis, 6) == every(position, axis, 3));
    CHECK(every(npy.values, axis + 3, 6) == every(velocity, axis, 3));
  }
  CHECK(ply.columns.at("J_P") == doubles(shot.read("plastic_det")));
  CHECK(read_npy_file(folder.path() / "export" / "particles_0000_J_P.npy").values == doubles(shot.read("plastic_det")));
  check_near(read_npy_file(folder.path() / "export" / "particles_0000_stress_norm.npy").values, norms(shot));
  CHECK(read_npy_file(folder.path() / "export" / "particles_0000_material.npy").values.size() == position.size() / 3);
}

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

TEST_CASE("the surface is closed, looks outwards, and holds about as much as the snow") {
  if (!firn::stages::has_openvdb()) return;
  Folder folder;
  SceneText scene;
  std::string text = scene.text();
  text.replace(text.find("radius: 0.1"), 11, "radius: 0.4");
  Shot shot(text, "[mpm.seed]", "[render.background, io.surface, {io.surface: {format: obj, level: 0.5}}]", small_image,
            folder.path().string());
  write_frames(shot, 1);
  const ObjFile obj = read_obj(folder.path() / "export" / "surface_0000.obj");
  const double exact = 4.0 / 3.0 * M_PI * 0.4 * 0.4 * 0.4;
  CHECK(is_watertight(obj.faces));
  CHECK(volume_of(obj.points, obj.faces) == Approx(exact).epsilon(0.1));
  const PlyFile ply = read_ply(folder.path() / "export" / "surface_0000.ply");
  CHECK(is_watertight(ply.faces));
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i < ply.columns.at("x").size(); ++i)
    points.push_back({ply.columns.at("x")[i], ply.columns.at("y")[i], ply.columns.at("z")[i]});
  CHECK(volume_of(points, ply.faces) == Approx(exact).epsilon(0.05));
  CHECK(volume_of(points, ply.faces) > volume_of(obj.points, obj.faces));  // a lower level lies farther out
}

TEST_CASE("bodies are written where they are, each shape with its volume") {
  Folder folder;
  SceneText scene;
  folder.write("tetrahedron.obj", "v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  scene.bodies =
      "[{sphere: {radius: 0.2}, position: [0.5, 0, 0]}, {box: {size: [0.1, 0.2, 0.3]}, position: [-0.5, 0, 0], orientation: {axis: "
      "[0, 0, 1], degrees: 90}}, {capsule: {from: [0, 0, 0], to: [0, 0, 0.4], radius: 0.1}}, {plane: {normal: [0, 1, 0]}, name: a "
      "plane}, {mesh: {file: " +
      (folder.path() / "tetrahedron.obj").string() + "}, mass: 2, position: [0, -0.5, 0]}]";
  Shot shot(scene.text(), "[bodies.place]",
            "[render.background, io.bodies, {io.bodies: {format: obj}}, {io.bodies: {format: poses}}]", small_image,
            folder.path().string());
  write_frames(shot, 1);
  const ObjFile obj = read_obj(folder.path() / "export" / "bodies_0000.obj");
  CHECK(obj.objects == std::vector<std::string>{"body_1", "body_2", "body_3", "a_plane", "body_5"});
  const VtkFile vtp = read_vtk(folder.path() / "export" / "bodies_0000.vtp");
  REQUIRE(vtp.arrays.at("body").size() == obj.faces.size());
  std::vector<double> corners;
  for (const auto& f : obj.faces)
    for (const int c : f) corners.push_back(c);
  CHECK(vtp.arrays.at("connectivity") == corners);
  const double expected[] = {4.0 / 3 * M_PI * 0.008, 0.006, M_PI * 0.01 * (0.4 + 4.0 / 3 * 0.1), 0, 0.027 / 6};
  const std::array<double, 3> middle[] = {{0.5, 0, 0}, {-0.5, 0, 0}, {0, 0, 0.2}, {}, {}};
  for (int b = 0; b < 5; ++b) {
    INFO("body " << b);
    std::vector<std::array<int, 3>> faces;
    for (std::size_t f = 0; f < obj.faces.size(); ++f)
      if (vtp.arrays.at("body")[f] == b) faces.push_back(obj.faces[f]);
    if (b == 3) continue;
    if (b < 4) CHECK(is_watertight(faces));
    CHECK(volume_of(obj.points, faces) == Approx(expected[b]).epsilon(0.01));
    if (b > 2) continue;
    std::array<double, 3> low{9, 9, 9}, high{-9, -9, -9};
    for (const auto& f : faces)
      for (const int c : f)
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], obj.points[static_cast<std::size_t>(c)][a]);
          high[a] = std::max(high[a], obj.points[static_cast<std::size_t>(c)][a]);
        }
    for (std::size_t a = 0; a < 3; ++a) CHECK(0.5 * (low[a] + high[a]) == Approx(middle[b][a]).margin(1e-6));
    if (b == 1) CHECK(high[0] - low[0] == Approx(0.2));  // turned by a right angle
  }
  const std::string table = bytes_of(folder.path() / "export" / "bodies_0000.csv");
  CHECK(table.starts_with("frame,time,body,name,mesh,x,y,z,qx,qy,qz,qw\n0,0,0,\"body 1\",body_000.obj,0.5,0,0,0,0,0,1\n"));
  const ObjFile own = read_obj(folder.path() / "export" / "body_001.obj");
  CHECK(volume_of(own.points, own.faces) == Approx(0.006));
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
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = 0.03f * static_cast<float>(i);
  shot.write("depth", depth);
  write_frames(shot, 1);
  const fs::path exports = folder.path() / "export";

  const VtkFile vti = read_vtk(exports / "heightfield_0000.vti");
  CHECK(vti.arrays.at("depth") == doubles(depth));
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
    CHECK(obj.points[i][1] == Approx(0.25 + static_cast<double>(depth[i])));
    CHECK(obj.points[i][2] == Approx(z));
    CHECK(ply.columns.at("y")[i] == Approx(obj.points[i][1]));
  }
  for (const auto& f : obj.faces) {  // seen from above
    const auto &a = obj.points[static_cast<std::size_t>(f[0])], &b = obj.points[static_cast<std::size_t>(f[1])],
               &c = obj.points[static_cast<std::size_t>(f[2])];
    CHECK((b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]) > 0);
  }
}

TEST_CASE("a full disk while exporting is an error that names the file, and leaves no half file") {
  Folder folder;
  Strained shot("[render.background, io.particles]", folder.path());
  std::string said = "no error";
  {
    const SmallDisk disk(1000);
    try {
      shot.frame();
      shot.execution().finish();
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
  }
  INFO(said);
  CHECK(said.find((folder.path() / "export" / "particles_0000.vtp").string()) != std::string::npos);
  CHECK(said.find("File too large") != std::string::npos);
  CHECK(names_in(folder.path() / "export").empty());
}
