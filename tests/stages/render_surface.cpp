// Snow drawn as one surface: where its particles are, hidden and hiding, in its colour and in the sun.

#include <algorithm>

#include "config/diagnostics.h"
#include "stages/snow_surface.h"
#include "stages/vdb_files.h"
#include "tests/catch.h"
#include "tests/stages/render_shot.h"

using namespace firn;
using namespace firn::test;
using scene::Vector3d;

namespace {

const char* const surface_drawn = "[render.shadow_map, render.background, render.surface]";

// The ball of the scene with this radius.
std::string with_ball(const SceneText& scene, const std::string& radius) {
  std::string text = scene.text();
  return text.replace(text.find("radius: 0.1"), 11, "radius: " + radius);
}

Shot shot_of(const SceneText& scene, const std::string& radius, const std::string& stages) {
  return {with_ball(scene, radius), "[mpm.seed, bodies.place]", stages, "320x180"};
}

bool is_red(const Pixel& pixel) { return 2 * pixel[0] > 3 * pixel[1] && 2 * pixel[0] > 3 * pixel[2]; }

}  // namespace

TEST_CASE("the surface of a ball covers its disc, and round it the picture is the background") {
  if (!stages::has_openvdb()) return;
  // Of a plain edge the density's half is at the edge.
  const Picture drawn = shot_of({}, "0.4", "[render.shadow_map, render.background, {render.surface: {level: 0.5}}]").frame();
  Shot without = shot_of({}, "0.4", "[render.shadow_map, render.background]");
  const Picture background = without.frame();
  const auto [left, bottom] = without.pixel_of({0, 0.5, 0});
  // The outline of a ball of radius r seen from distance d is that of a disc of radius r d / sqrt(d^2 - r^2) through its centre.
  const double pixels = 0.5 * 180 / std::tan(20 * M_PI / 180) * 0.4 / std::sqrt(16 - 0.16);
  int covered = 0, strayed = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) {
      if (drawn.at(x, y) == background.at(x, y)) continue;
      ++covered;
      if (std::hypot(x - left, y - bottom) > 1.06 * pixels) ++strayed;  // half a cell outside
    }
  CHECK(strayed == 0);
  CHECK(covered == Approx(M_PI * pixels * pixels).epsilon(0.06));
}

TEST_CASE("a surface hides the body behind it and is hidden by the body before it") {
  if (!stages::has_openvdb()) return;
  SceneText scene;
  const bool before = GENERATE(true, false);
  CAPTURE(before);
  const double z = before ? 0.8 : -0.8;
  scene.bodies = "[{sphere: {radius: 0.4}, position: [0, 0.5, " + std::to_string(z) + "], color: [0.9, 0.05, 0.05]}]";
  Shot shot = shot_of(scene, "0.2", "[render.background, render.surface]");
  shot.frame();
  CHECK(is_red(shot.at({0, 0.5, 0})) == before);
  CHECK(is_red(shot.at({0.37, 0.5, z})));
}

TEST_CASE("a surface has the colour of the material there, white in the sun and bluish in shade") {
  if (!stages::has_openvdb()) return;
  SceneText scene;
  SECTION("red snow") {
    scene.color = "[0.9, 0.1, 0.1]";
    Shot shot = shot_of(scene, "0.2", surface_drawn);
    shot.frame();
    CHECK(is_red(shot.at({0, 0.6, 0})));
  }
  SECTION("two materials side by side") {
    std::string text = scene.text();
    const std::string one = "white: {preset: packed, color: [1, 1, 1]}";
    text.replace(text.find(one), one.size(),
                 "white: {preset: packed, color: [0.9, 0.1, 0.1]}, other: {preset: packed, color: [0.1, 0.9, 0.1]}");
    const std::string snow = "snow:\n";
    text.replace(text.find(snow), snow.size(),
                 "snow:\n  - {sphere: {center: [0.5, 0.5, 0], radius: 0.2}, material: other, per_cell: 8}\n");
    Shot shot(text, "[mpm.seed, bodies.place]", surface_drawn, "320x180");
    shot.frame();
    CHECK(is_red(shot.at({0, 0.5, 0})));
    const Pixel other = shot.at({0.5, 0.5, 0});
    CHECK(other[1] > 2 * other[0]);
  }
  SECTION("in the sun") {
    scene.camera = "{from: [0, 4, 0.1], to: [0, 0.5, 0], fov: 20}";
    Shot shot = shot_of(scene, "0.2", surface_drawn);
    shot.frame();
    const Pixel pixel = shot.at({0, 0.7, 0});
    CHECK(*std::min_element(pixel.begin(), pixel.end()) > 190);
    CHECK(*std::max_element(pixel.begin(), pixel.end()) - *std::min_element(pixel.begin(), pixel.end()) < 25);
  }
  SECTION("under a roof") {
    scene.bodies = "[{box: {size: [0.8, 0.02, 0.8]}, position: [0, 0.9, 0]}]";
    scene.camera = "{from: [0, 0.55, 4], to: [0, 0.5, 0], fov: 20}";
    Shot shot = shot_of(scene, "0.2", surface_drawn);
    shot.frame();
    const Pixel pixel = shot.at({0, 0.65, 0.13});
    CHECK(brightness(pixel) < 420);
    CHECK(pixel[2] > pixel[0] + 8);
  }
}

TEST_CASE("a surface follows its particles and leaves nothing of the last picture") {
  if (!stages::has_openvdb()) return;
  Shot shot = shot_of({}, "0.2", surface_drawn);
  const Picture first = shot.frame();
  const std::vector<float> position = shot.read("position");
  std::vector<float> moved = position;
  for (std::size_t i = 0; i < moved.size(); i += 3) moved[i] += 0.5f;
  shot.write("position", moved);
  const Picture second = shot.frame(), background = shot_of({}, "0.2", "[render.background]").frame();
  const auto [old_x, old_y] = shot.pixel_of({0, 0.5, 0});
  const auto [x, y] = shot.pixel_of({0.5, 0.5, 0});
  CHECK(second.at(old_x, old_y) == background.at(old_x, old_y));
  CHECK(first.at(x, y) == background.at(x, y));
  CHECK_FALSE(second.at(x, y) == background.at(x, y));
  shot.write("position", position);
  CHECK(shot.frame() == first);
}

TEST_CASE("a surface with more corners than there is room for ends the run with what to do") {
  if (!stages::has_openvdb()) return;
  SceneText scene;
  std::string text = with_ball(scene, "0.4");
  text.replace(text.find("per_cell: 8"), 11, "per_cell: 1");
  Shot shot(text, "[mpm.seed]", "[render.background, {render.surface: {cell: 0.25, smoothing: 4}}]", "64x36");
  std::string told;
  try {
    shot.frame();
  } catch (const std::runtime_error& error) {
    told = error.what();
  }
  INFO(told);
  CHECK(told.starts_with("render.surface: the surface of the snow has "));
  CHECK(told.find("larger 'cell'") != std::string::npos);
}

TEST_CASE("the normals of a surface are unit vectors away from a ball's centre") {
  if (!stages::has_openvdb()) return;
  std::vector<float> position, volume, carried;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j)
      for (int k = -20; k <= 20; ++k) {
        const Vector3d x(0.025 * i, 0.025 * j, 0.025 * k);
        if (x.norm() > 0.5) continue;
        for (const double part : x) {
          position.push_back(static_cast<float>(part));
          carried.push_back(static_cast<float>(part));
        }
        volume.push_back(0.025f * 0.025f * 0.025f);
      }
  scene::Domain domain;
  domain.min = {-1, -1, -1};
  domain.max = {1, 1, 1};
  domain.cell = 0.05;
  const stages::SurfaceShape shape{1, 0.4, 1};
  const stages::NodeField share = stages::share_of_snow(position, volume, carried, domain, shape);
  const scene::TriangleMesh mesh = stages::snow_surface(share, shape);
  const auto normals = stages::outward_normals(mesh);
  const auto places = stages::velocity_at(share, mesh.points);  // what was carried is where the particles are
  REQUIRE(mesh.points.size() > 500);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Vector3d normal(normals[i][0], normals[i][1], normals[i][2]), place(places[i][0], places[i][1], places[i][2]);
    CHECK(normal.norm() == Approx(1).epsilon(1e-5));
    CHECK(normal.dot(mesh.points[i].normalized()) > 0.85);
    CHECK((place - mesh.points[i]).norm() < 0.06);  // of the snow near by, which is within
  }
}
