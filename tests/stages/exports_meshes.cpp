// The snow's surface and rigid bodies, as meshes in files.

#include <cmath>

#include "stages/vdb_files.h"
#include "tests/stages/export_shot.h"

using namespace firn::test;
namespace fs = std::filesystem;

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
      "[0, 0, 1], degrees: 90}}, {capsule: {from: [0, 0, 0], to: [0, 0, 0.4], radius: 0.1}}, {plane: {normal: [0, 1, 0]}, name: 'a "
      "\"flat\" "
      "plane'}, {mesh: {file: " +
      (folder.path() / "tetrahedron.obj").string() + "}, mass: 2, position: [0, -0.5, 0]}]";
  Shot shot(scene.text(), "[bodies.place]",
            "[render.background, io.bodies, {io.bodies: {format: obj}}, {io.bodies: {format: poses}}]", small_image,
            folder.path().string());
  write_frames(shot, 2);
  const ObjFile obj = read_obj(folder.path() / "export" / "bodies_0000.obj");
  CHECK(obj.objects == std::vector<std::string>{"body_1", "body_2", "body_3", "a_\"flat\"_plane", "body_5"});
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
    if (b == 3) {  // a square, whose edge is twice the domain's diagonal
      const auto &p = obj.points[static_cast<std::size_t>(faces[0][0])], &q = obj.points[static_cast<std::size_t>(faces[0][1])];
      CHECK(std::abs(p[2] - q[2]) == Approx(2 * std::sqrt(12.0)));
      continue;
    }
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
  // The box is turned by a right angle about z.
  CHECK(table.find("0,0,1,\"body 2\",body_001.obj,-0.5,0,0,0,0,0.707106") != std::string::npos);
  CHECK(table.find("0,0,3,\"a \"\"flat\"\" plane\",body_003.obj,") != std::string::npos);
  CHECK(bytes_of(folder.path() / "export" / "bodies_0001.csv").find("\n1,0.125,0,\"body 1\",") != std::string::npos);
  const ObjFile own = read_obj(folder.path() / "export" / "body_001.obj");
  CHECK(volume_of(own.points, own.faces) == Approx(0.006));
}

TEST_CASE("a half-space in a scene with a field is as wide as the field") {
  Folder folder;
  const std::string scene =
      "firn: 1\nname: field\nfield: {size: [30, 40], cells: [30, 40], depth: 0.5, material: new_snow}\nbodies: [{plane: {normal: "
      "[0, "
      "1, 0]}}]\n";
  Shot shot(scene, "[heightfield.init, bodies.place]", "[render.background, {io.bodies: {format: obj}}]", small_image,
            folder.path().string());
  write_frames(shot, 1);
  double widest = 0;
  for (const std::array<double, 3>& point : read_obj(folder.path() / "export" / "bodies_0000.obj").points)
    widest = std::max(widest, std::abs(point[0]));
  CHECK(widest == Approx(50));
}

TEST_CASE("smaller cells make a finer surface, and smoothing a smaller one") {
  if (!firn::stages::has_openvdb()) return;
  SceneText scene;
  std::string text = scene.text();
  text.replace(text.find("radius: 0.1"), 11, "radius: 0.4");
  const auto surface = [&](const std::string& parameters) {
    Folder folder;
    Shot shot(text, "[mpm.seed]", "[render.background, {io.surface: {format: obj, " + parameters + "}}]", small_image,
              folder.path().string());
    write_frames(shot, 1);
    return read_obj(folder.path() / "export" / "surface_0000.obj");
  };
  const ObjFile plain = surface("level: 0.7"), fine = surface("level: 0.7, cell: 0.7"),
                smooth = surface("level: 0.7, smoothing: 4");
  CHECK(static_cast<double>(fine.faces.size()) > 1.6 * static_cast<double>(plain.faces.size()));
  CHECK(volume_of(smooth.points, smooth.faces) < volume_of(plain.points, plain.faces));
}
