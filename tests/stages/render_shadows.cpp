// Where shadows fall.

#include "tests/catch.h"
#include "tests/stages/render_shot.h"

using namespace firn::test;
using firn::scene::Vector3d;

namespace {

const std::string ground = "{plane: {point: [0, -0.5, 0], normal: [0, 1, 0]}, color: [0.6, 0.6, 0.6]}";

SceneText over_ground(const std::string& more_bodies = "") {
  SceneText scene;
  scene.bodies = "[" + ground + more_bodies + "]";
  scene.camera = "{from: [0, 1.5, 5], to: [0, -0.2, 0], fov: 40}";
  scene.sun = "[1, -2, 0]";
  return scene;
}

// How much of its light a place on the ground keeps when shadows are drawn, in sRGB brightness.
struct Shade {
  explicit Shade(const SceneText& scene)
      : with(scene, "[render.shadow_map, {render.background: {ruler: 0}}, render.particles]", "640x360"),
        without(scene, "[{render.background: {ruler: 0}}, render.particles]", "640x360") {
    with.frame();
    without.frame();
  }
  [[nodiscard]] double at(const Vector3d& place) const {
    return static_cast<double>(brightness(with.at(place))) / brightness(without.at(place));
  }
  Shot with, without;
};

}  // namespace

TEST_CASE("the shadow of snow falls where the sun's rays through it meet the ground, and nowhere else") {
  // From (0, 0.5, 0) along (1, -2, 0) down to y = -0.5: (0.5, -0.5, 0). Its length along x: 2 * 0.1 * sqrt(5) / 2.
  const Shade shade(over_ground());
  for (const Vector3d& in : {Vector3d(0.5, -0.5, 0), Vector3d(0.43, -0.5, 0), Vector3d(0.57, -0.5, 0), Vector3d(0.5, -0.5, 0.06)})
    CHECK(shade.at(in) < 0.75);
  for (const Vector3d& out : {Vector3d(0.33, -0.5, 0), Vector3d(0.67, -0.5, 0), Vector3d(0.5, -0.5, 0.16),
                              Vector3d(0.5, -0.5, -0.16), Vector3d(0, -0.5, 0), Vector3d(-0.5, -0.5, 0), Vector3d(1.5, -0.5, 0.5)})
    CHECK(shade.at(out) == Approx(1).epsilon(0.02));
}

TEST_CASE("bodies of every kind cast shadows of their shape") {
  const std::string shape = GENERATE("sphere: {radius: 0.15}", "box: {size: [0.3, 0.3, 0.3]}",
                                     "capsule: {from: [0, 0, -0.2], to: [0, 0, 0.2], radius: 0.15}");
  CAPTURE(shape);
  const Shade shade(over_ground(", {" + shape + ", position: [-0.5, 0, 0]}"));
  CHECK(shade.at({-0.25, -0.5, 0}) < 0.75);
  CHECK(shade.at({-0.25, -0.5, 0.12}) < 0.75);
  CHECK(shade.at({-0.25, -0.5, 0.45}) == Approx(1).epsilon(0.02));
  const bool long_one = shape.starts_with("capsule");
  CHECK((shade.at({-0.25, -0.5, 0.25}) < 0.75) == long_one);
}

TEST_CASE("half-spaces cast no shadow") {
  const Shade shade(
      over_ground(", {plane: {point: [-0.9, 0, 0], normal: [1, 0, 0]}}, {plane: {point: [0, 0.9, 0], normal: [0, -1, 0]}}"));
  for (const double x : {-0.8, -0.2, 0.2, 0.9}) CHECK(shade.at({x, -0.5, 0.2}) == Approx(1).epsilon(0.02));
}

TEST_CASE("a body in the sun's way shades the snow") {
  SceneText scene = over_ground(", {box: {size: [0.5, 0.05, 0.5]}, position: [-0.2, 0.9, 0]}");
  const Shade shade(scene);
  CHECK(shade.at({0, 0.57, 0.06}) < 0.85);
}

TEST_CASE("walls are panes, solid or hidden, as asked for, none is drawn that the camera stands in") {
  const std::string wall = "{plane: {point: [0, 0, -0.8], normal: [0, 0, 1]}, color: [0.9, 0.05, 0.05]}";
  const std::string before = "{plane: {point: [0, 0, 0.8], normal: [0, 0, -1]}, color: [0.05, 0.9, 0.05]}";
  SceneText scene;
  scene.bodies = "[" + wall + ", " + before + "]";
  const auto pixel = [&](const std::string& walls) {
    Shot shot(scene, "[{render.background: {walls: " + walls + "}}, render.particles]");
    shot.frame();
    return shot.at({0.4, 0.7, -0.8});
  };
  const Pixel glass = pixel("glass"), solid = pixel("solid"), hidden = pixel("hidden");
  CHECK(solid[0] > solid[1] + 30);
  CHECK(hidden[2] > hidden[0]);
  CHECK(brightness(glass) != brightness(hidden));
  for (int c = 0; c < 3; ++c) CHECK(std::abs(glass[static_cast<std::size_t>(c)] - hidden[static_cast<std::size_t>(c)]) < 40);
  const std::string around = "{plane: {point: [0, 0, 5], normal: [0, 0, 1]}, color: [0.05, 0.9, 0.05]}";
  scene.bodies = "[" + wall + ", " + around + "]";
  CHECK(pixel("solid") == solid);
}
