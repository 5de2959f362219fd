// The several ways to write one thing, and what holds where nothing is written.

#include <cmath>
#include <numbers>

#include "scene/materials.h"
#include "scene/solid.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const std::string head = "firn: 1\ndomain: {min: [0, 0, 0], max: [2, 2, 2], cell: 0.1}\n";
const std::string ball = "snow: [{sphere: {center: [1, 1, 1], radius: 0.5}, material: packed}]\n";

scene::Body body_of(const std::string& text) { return good_scene(head + ball + "bodies: [" + text + "]\n").bodies.at(0); }
scene::Snow snow_of(const std::string& text) { return good_scene(head + "snow: [" + text + "]\n").snow.at(0); }
bool near(const Vector3d& a, const Vector3d& b) { return (a - b).norm() < 1e-12; }

}  // namespace

TEST_CASE("a scene may say little: everything else has its default") {
  const scene::Scene scene = good_scene(head + ball, "folder/small.yaml");
  CHECK(scene.name == "small");
  CHECK(scene.seed == 1);
  CHECK_FALSE(scene.time.dt.has_value());
  CHECK(scene.time.cfl == 0.4);
  CHECK(scene.time.fps == 30);
  CHECK(scene.time.end == 1);
  CHECK(scene.gravity == Vector3d(0, -9.81, 0));
  CHECK(scene.bodies.empty());
  CHECK_FALSE(scene.field.has_value());
  CHECK(scene.snow[0].per_cell == 8);
  CHECK(scene.snow[0].velocity == Vector3d(0, 0, 0));
}

TEST_CASE("bodies may be an empty list, or a key with nothing behind it") {
  CHECK(good_scene(head + ball + "bodies: []\n").bodies.empty());
  CHECK(good_scene(head + ball + "bodies:\n").bodies.empty());
}

TEST_CASE("dt: auto leaves the step open") {
  CHECK_FALSE(good_scene(head + ball + "time: {dt: auto, cfl: 0.2}\n").time.dt.has_value());
}

TEST_CASE("a material takes its preset's numbers and overrides those given") {
  const scene::Scene scene =
      good_scene(head +
                 "materials: {mine: {preset: wet_old, hardening: 3}, plain: {}}\nsnow: [{sphere: {center: [1, 1, 1], radius: "
                 "0.5}, material: mine}]\n");
  const scene::Material& preset = scene::find_preset("wet_old")->material;
  const scene::Material& mine = scene.materials.at(0);
  CHECK(mine.name == "mine");
  CHECK(mine.preset == "wet_old");
  CHECK(mine.hardening == 3);
  CHECK(mine.density == preset.density);
  CHECK(mine.young == preset.young);
  CHECK(mine.critical_compression == preset.critical_compression);
  CHECK(mine.max_density == preset.max_density);
  CHECK(scene.materials.at(1).preset.empty());
  CHECK(scene.materials.at(1).young == 1.4e5);
}

TEST_CASE("a preset may be used by its name, is added once, and gives way to a material of that name") {
  const std::string two =
      "snow:\n  - {sphere: {center: [1, 1, 1], radius: 0.5}, material: packed}\n  - {sphere: {center: [1, 1, 1], radius: 0.4}, "
      "material: "
      "packed}\n";
  const scene::Scene scene = good_scene(head + two);
  REQUIRE(scene.materials.size() == 1);
  CHECK(scene.materials[0].name == "packed");
  CHECK(scene.snow[1].material == 0);
  const scene::Scene own = good_scene(head + "materials: {packed: {density: 333}}\n" + two);
  REQUIRE(own.materials.size() == 1);
  CHECK(own.materials[0].density == 333);
}

TEST_CASE("orientations turn counter-clockwise about their axis, and quaternions are [x, y, z, w]") {
  const double half = std::sqrt(0.5);
  const Quaterniond by_axis =
      body_of("{box: {size: [1, 1, 1]}, position: [1, 1, 1], orientation: {axis: [0, 0, 3], degrees: 90}}").orientation;
  CHECK(near(by_axis * Vector3d(1, 0, 0), Vector3d(0, 1, 0)));
  const Quaterniond by_numbers =
      body_of("{box: {size: [1, 1, 1]}, position: [1, 1, 1], orientation: [0, 0, 0.70710678, 0.70710678]}").orientation;
  CHECK(by_numbers.angularDistance(by_axis) < 1e-7);
  CHECK(by_numbers.z() == Approx(half));
  CHECK(std::abs(by_numbers.norm() - 1) < 1e-15);
}

TEST_CASE("a box is the same by centre and size as by corners") {
  const auto by_center =
      std::get<scene::Box>(snow_of("{box: {center: [1, 0.9, 0.8], size: [0.4, 0.6, 0.8]}, material: packed}").what);
  const auto by_corners =
      std::get<scene::Box>(snow_of("{box: {min: [0.8, 0.6, 0.4], max: [1.2, 1.2, 1.2]}, material: packed}").what);
  CHECK(near(by_center.center, by_corners.center));
  CHECK(near(by_center.half_size, Vector3d(0.2, 0.3, 0.4)));
  CHECK(near(by_corners.half_size, by_center.half_size));
}

TEST_CASE("a body stands where its shape says when it has no position, with the shape about its origin") {
  CHECK(body_of("{sphere: {center: [1, 0.5, 1], radius: 0.2}}").position == Vector3d(1, 0.5, 1));
  CHECK(std::get<scene::Sphere>(body_of("{sphere: {center: [1, 0.5, 1], radius: 0.2}}").shape).center == Vector3d(0, 0, 0));
  CHECK(near(body_of("{box: {min: [0, 0, 0], max: [1, 2, 1]}}").position, Vector3d(0.5, 1, 0.5)));
  const scene::Body capsule = body_of("{capsule: {from: [1, 0.5, 1], to: [1, 1.5, 1], radius: 0.2}}");
  CHECK(near(capsule.position, Vector3d(1, 1, 1)));
  CHECK(near(std::get<scene::Capsule>(capsule.shape).end, Vector3d(0, 0.5, 0)));
  CHECK(near(body_of("{capsule: {from: [0, -0.5, 0], to: [0, 0.5, 0], radius: 0.2}, position: [1, 1.2, 1]}").position,
             Vector3d(1, 1.2, 1)));
  CHECK(body_of("{plane: {normal: [0, 2, 0]}, position: [0, 0.3, 0]}").position == Vector3d(0, 0.3, 0));
  CHECK(std::get<scene::Plane>(body_of("{plane: {normal: [0, 2, 0]}}").shape).normal == Vector3d(0, 1, 0));
}

TEST_CASE("a body with a path starts at its first point and keeps its turn until the path gives another") {
  const scene::Body body = body_of(
      "{sphere: {radius: 0.2}, orientation: {axis: [0, 1, 0], degrees: 30}, path: [{t: 0, position: [1, 1, 1]}, {t: 1, position: "
      "[1, 1, 1.5], "
      "orientation: {axis: [0, 1, 0], degrees: 60}}, {t: 2, position: [1, 1, 1]}]}");
  CHECK(body.position == Vector3d(1, 1, 1));
  REQUIRE(body.path.size() == 3);
  const auto degrees = [](const Quaterniond& turn) { return 2 * std::acos(turn.w()) * 180 / std::numbers::pi; };
  CHECK(degrees(body.path[0].orientation) == Approx(30));
  CHECK(degrees(body.path[1].orientation) == Approx(60));
  CHECK(degrees(body.path[2].orientation) == Approx(60));
}

TEST_CASE("the bounds of turned shapes hold every point of them, tightly") {
  const Quaterniond turn(Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ()));
  const scene::Bounds box = scene::bounds_of({scene::Box{{1, 1, 1}, {0.5, 0.5, 0.25}}, turn});
  CHECK(near(box.max, Vector3d(1 + std::sqrt(0.5), 1 + std::sqrt(0.5), 1.25)));
  const scene::Bounds capsule = scene::bounds_of({scene::Capsule{{-1, 0, 0}, {1, 0, 0}, 0.5}, turn});
  CHECK(near(capsule.min, Vector3d(-std::sqrt(0.5) - 0.5, -std::sqrt(0.5) - 0.5, -0.5)));
}

TEST_CASE("inside: turned boxes and capsules about their own centre") {
  const Quaterniond quarter(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()));
  const scene::Inside box({scene::Box{{1, 1, 1}, {0.5, 0.1, 0.1}}, quarter});
  CHECK(box(Vector3d(1, 1.45, 1)));
  CHECK_FALSE(box(Vector3d(1.45, 1, 1)));
  const scene::Inside capsule({scene::Capsule{{0.5, 1, 1}, {1.5, 1, 1}, 0.1}, quarter});
  CHECK(capsule(Vector3d(1, 1.55, 1)));
  CHECK_FALSE(capsule(Vector3d(1, 1.65, 1)));
  CHECK_FALSE(capsule(Vector3d(1.2, 1, 1)));
}

TEST_CASE("files are found beside the scene, whatever the working directory") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "meshes");
  folder.write("meshes/a.obj", "v 0 0 0\n");
  const scene::Scene scene = good_scene(head + ball + "bodies: [{mesh: {file: meshes/a.obj, scale: 0.5}}]\n", folder / "s.yaml");
  const auto& mesh = std::get<scene::Mesh>(scene.bodies[0].shape);
  CHECK(mesh.file == (folder / "meshes/a.obj").string());
  CHECK(mesh.scale == 0.5);
}

TEST_CASE("a field alone is a scene, with images for all three of its maps") {
  const TemporaryFolder folder;
  folder.write("a.png", "not looked at yet");
  const scene::Scene scene = good_scene(
      "firn: 1\nfield: {size: [2, 4], cells: [32, 64], ground: {image: a.png, metres: -0.5}, depth: {image: a.png, metres: 0.5}, "
      "density: {image: a.png, "
      "density: 150}, material: new_snow}\n",
      folder / "s.yaml");
  CHECK(scene.field->ground.unit_value == -0.5);
  CHECK(scene.field->depth.image == (folder / "a.png").string());
  CHECK(scene.field->density.unit_value == 150);
  CHECK_FALSE(scene.domain.has_value());
}

TEST_CASE("a field without density takes its material's") {
  CHECK(good_scene("firn: 1\nfield: {size: [2, 4], cells: [32, 64], depth: 0.5, material: new_snow}\n").field->density.value ==
        100);
}

TEST_CASE("nodes lie on both ends of the domain, also where rounding makes the quotient inexact") {
  scene::Domain domain;
  domain.min = Vector3d(-0.3, 0.1, 0);
  domain.max = Vector3d(0.3, 1.0, 2.1);
  domain.cell = 0.1;
  CHECK(domain.nodes() == Eigen::Vector3i(7, 10, 22));
}

TEST_CASE("a body may turn by a mass, a spin or a path that turns it, and by nothing else") {
  const std::string box = "{box: {size: [0.1, 0.1, 0.1]}, ";
  CHECK_FALSE(scene::may_turn(body_of(box + "position: [1, 1, 1], velocity: [1, 0, 0]}")));
  CHECK(scene::may_turn(body_of(box + "position: [1, 1, 1], mass: 2}")));
  CHECK(scene::may_turn(body_of(box + "position: [1, 1, 1], spin: [0, 0, 0.1]}")));
  const std::string there = "{t: 0, position: [1, 1, 1]}, ";
  CHECK_FALSE(scene::may_turn(body_of(box + "path: [" + there + "{t: 1, position: [1.2, 1, 1]}]}")));
  CHECK(scene::may_turn(body_of(box + "path: [" + there + "{t: 1, position: [1, 1, 1], orientation: [0, 1, 0, 0]}]}")));
}

}  // namespace firn::test
