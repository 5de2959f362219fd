// What must be seen in pictures: what is where, what hides what, and where shadows fall.

#include <algorithm>
#include <random>

#include "config/diagnostics.h"
#include "tests/catch.h"
#include "tests/stages/render_shot.h"

using namespace firn::test;
using firn::scene::Vector3d;

namespace {

// Snow out of sight, behind the camera.
SceneText bodies_only(const std::string& bodies) {
  SceneText scene;
  scene.bodies = bodies;
  scene.snow = "[0, 0.5, 0.8]";
  scene.camera = "{from: [0, 0.5, 0.6], to: [0, 0.5, 0], fov: 60}";
  return scene;
}

bool is_red(const Pixel& pixel) { return pixel[0] > 2 * pixel[1] && pixel[0] > 2 * pixel[2]; }
bool is_green(const Pixel& pixel) { return pixel[1] > 2 * pixel[0] && pixel[1] > 2 * pixel[2]; }
bool is_sky(const Pixel& pixel) { return pixel[2] > pixel[0] && brightness(pixel) > 200; }

const std::string ground = "{plane: {point: [0, 0, 0], normal: [0, 1, 0]}, color: [0.6, 0.6, 0.6]}";

std::string errors_of(const SceneText& scene, const std::string& stages) {
  try {
    Shot(scene, stages);
  } catch (const firn::config::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a body of every kind is seen in its colour in the middle, the sky in the corners") {
  const std::string shape = GENERATE("sphere: {radius: 0.1}", "box: {size: [0.2, 0.2, 0.2]}",
                                     "capsule: {from: [0, -0.1, 0], to: [0, 0.1, 0], radius: 0.1}");
  CAPTURE(shape);
  Shot shot(bodies_only("[{" + shape + ", position: [0, 0.5, 0], color: [0.9, 0.05, 0.05]}]"));
  const Picture picture = shot.frame();
  CHECK(is_red(picture.at(80, 45)));
  for (const int x : {0, 159})
    for (const int y : {0, 89}) CHECK(is_sky(picture.at(x, y)));
}

TEST_CASE("a body's outline is where its shape ends") {
  Shot shot(
      bodies_only("[{box: {size: [0.2, 0.2, 0.2]}, position: [0, 0.5, -0.1], orientation: {axis: [0, 0, 1], degrees: 45}, color: "
                  "[0.9, 0.05, 0.05]}]"));
  shot.frame();
  // The box's front face at z = 0 is a square on its corner.
  const double corner = 0.1 * std::sqrt(2.0);
  for (const Vector3d& way : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    CHECK(is_red(shot.at(Vector3d(0, 0.5, 0) + 0.92 * corner * way)));
    CHECK_FALSE(is_red(shot.at(Vector3d(0, 0.5, 0) + 1.08 * corner * way)));
  }
  CHECK_FALSE(is_red(shot.at({0.09, 0.59, 0})));
}

TEST_CASE("of two bodies on one ray the nearer is seen, whatever their order") {
  const std::string near_one = GENERATE("sphere: {radius: 0.05}", "box: {size: [0.1, 0.1, 0.1]}",
                                        "capsule: {from: [0, -0.01, 0], to: [0, 0.01, 0], radius: 0.05}");
  const std::string far_one = GENERATE("sphere: {radius: 0.15}", "box: {size: [0.3, 0.3, 0.3]}",
                                       "capsule: {from: [0, -0.01, 0], to: [0, 0.01, 0], radius: 0.15}");
  const bool red_first = GENERATE(true, false);
  CAPTURE(near_one, far_one, red_first);
  const std::string red = "{" + near_one + ", position: [0, 0.5, 0.2], color: [0.9, 0.05, 0.05]}";
  const std::string green = "{" + far_one + ", position: [0, 0.5, -0.2], color: [0.05, 0.9, 0.05]}";
  Shot shot(bodies_only(red_first ? "[" + red + ", " + green + "]" : "[" + green + ", " + red + "]"));
  shot.frame();
  CHECK(is_red(shot.at({0, 0.5, 0.2})));
  CHECK(is_green(shot.at({0.13, 0.5, -0.2})));
}

TEST_CASE("snow hides the body behind it and is hidden by the body before it") {
  SceneText scene;
  const bool before = GENERATE(true, false);
  const std::string detail = GENERATE("spheres", "grains");
  CAPTURE(before, detail);
  scene.bodies =
      std::string("[{sphere: {radius: 0.3}, position: [0, 0.5, ") + (before ? "0.5" : "-0.5") + "], color: [0.9, 0.05, 0.05]}]";
  Shot shot(scene, "[render.background, {render.particles: {detail: " + detail + "}}]");
  shot.frame();
  CHECK(is_red(shot.at({0, 0.5, 0})) == before);
  CHECK(is_red(shot.at({0.2, 0.5, 0})));
}

TEST_CASE("snow is white in the sun, bluish and darker in shade") {
  SceneText scene;
  scene.camera = "{from: [0, 4, 0.1], to: [0, 0.5, 0], fov: 20}";
  SECTION("in the sun") {
    Shot shot(scene);
    const Pixel pixel = (shot.frame(), shot.at({0, 0.6, 0}));
    CHECK(*std::min_element(pixel.begin(), pixel.end()) > 190);
    CHECK(*std::max_element(pixel.begin(), pixel.end()) - *std::min_element(pixel.begin(), pixel.end()) < 25);
  }
  SECTION("under a roof") {
    scene.bodies = "[{box: {size: [0.8, 0.02, 0.8]}, position: [0, 0.9, 0]}]";
    scene.camera = "{from: [0, 0.55, 4], to: [0, 0.5, 0], fov: 20}";
    Shot shot(scene);
    const Pixel pixel = (shot.frame(), shot.at({0, 0.55, 0.08}));
    CHECK(brightness(pixel) < 420);
    CHECK(pixel[2] > pixel[0] + 8);
  }
}

TEST_CASE("a material's colour is that of its snow") {
  SceneText scene;
  scene.color = "[0.9, 0.1, 0.1]";
  Shot shot(scene);
  shot.frame();
  CHECK(is_red(shot.at({0, 0.5, 0})));
}

TEST_CASE("pressed snow is darker than loose snow") {
  SceneText scene;
  scene.camera = "{from: [0, 4, 0.1], to: [0, 0.5, 0], fov: 20}";
  Shot shot(scene);
  shot.frame();
  const int loose = brightness(shot.at({0, 0.6, 0}));
  shot.write("plastic_det", std::vector<float>(shot.read("plastic_det").size(), 0.75f));
  shot.frame();
  CHECK(brightness(shot.at({0, 0.6, 0})) < loose - 40);
}

TEST_CASE("colours by speed go from blue to red") {
  Shot shot(SceneText{}, "[render.background, {render.particles: {color_by: speed, speed_range: 2}}]");
  std::vector<float> velocity = shot.read("velocity");
  shot.frame();
  const Pixel slow = shot.at({0, 0.5, 0});
  CHECK(slow[2] > slow[0] + 40);
  for (std::size_t i = 0; i < velocity.size(); i += 3) velocity[i] = 3;
  shot.write("velocity", velocity);
  shot.frame();
  CHECK(is_red(shot.at({0, 0.5, 0})));
}

TEST_CASE("a new picture shows nothing of the last") {
  Shot shot(SceneText{});
  const Picture first = shot.frame();
  const std::vector<float> position = shot.read("position");
  std::vector<float> moved = position;
  for (std::size_t i = 0; i < moved.size(); i += 3) moved[i] += 0.5f;
  shot.write("position", moved);
  CHECK_FALSE(shot.frame() == first);
  shot.write("position", position);
  CHECK(shot.frame() == first);
}

TEST_CASE("a stage is refused where its pictures were not begun, with the stage that would") {
  const std::string errors = errors_of({}, "[render.particles]");
  INFO(errors);
  CHECK(errors.find("render.particles draws into 'image'") != std::string::npos);
  CHECK(errors.find("render.background would") != std::string::npos);
  CHECK(errors_of({}, "[render.background]").empty());
  CHECK(errors_of({}, "[render.shadow_map, render.background]").empty());
}

TEST_CASE("without bodies.place the sky is all there is") {
  const SceneText scene = bodies_only("[{sphere: {radius: 0.2}, position: [0, 0.5, 0], color: [0.9, 0.05, 0.05]}]");
  Folder folder;
  firn::app::Inputs inputs;
  inputs.scene = folder.write("scene.yaml", scene.text()).string();
  inputs.pipeline =
      folder
          .write("pipeline.yaml",
                 "firn: 1\nname: draw\nsetup: [mpm.seed]\nframe: [render.shadow_map, render.background, render.particles]\n")
          .string();
  inputs.image = "160x90";
  const firn::app::Loaded loaded = firn::app::load(inputs, "");
  firn::execution::Execution execution(device(), loaded.plan, loaded.registry, {shader_folders()});
  execution.setup();
  execution.frame();
  CHECK(is_sky(Picture{160, 90, execution.read("image")}.at(80, 45)));
}

TEST_CASE("the depth is 1 - near / distance along the camera's axis, 1 where there is nothing") {
  Shot shot(bodies_only("[{box: {size: [0.4, 0.4, 0.2]}, position: [0, 0.5, 0], color: [0.9, 0.05, 0.05]}]"),
            "[render.background]");
  shot.frame();
  const std::vector<float> depth = shot.read("image_depth");
  CHECK(depth.at(45 * 160 + 80) == Approx(1.0 - 0.02 / 0.5).epsilon(1e-5));
  CHECK(depth.at(45 * 160 + 70) == Approx(1.0 - 0.02 / 0.5).epsilon(1e-5));  // not the distance along the ray
  CHECK(depth.at(0) == 1.0f);
}

TEST_CASE("of several hundred bodies every pixel shows the nearest on its ray") {
  INFO("seed " << seed());
  std::mt19937_64 engine(seed());
  const auto random = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); };
  struct Ball {
    Vector3d place;
    double radius;
    bool red;
  };
  std::vector<Ball> balls;
  for (int i = 0; i < 200; ++i)
    balls.push_back({{random(-0.6, 0.6), random(0.1, 0.9), random(-0.9, 0)}, random(0.01, 0.05), i % 2 == 0});
  for (int i = 0; i < 90; ++i)
    balls.push_back({{0.02, 0.5, -0.9 + 0.01 * i}, 0.03, i % 3 == 0});  // more in a row than a list holds
  std::string bodies;
  for (const Ball& ball : balls)
    bodies += "{sphere: {radius: " + std::to_string(ball.radius) + "}, position: [" + std::to_string(ball.place.x()) + ", " +
              std::to_string(ball.place.y()) + ", " + std::to_string(ball.place.z()) +
              "], color: " + (ball.red ? "[0.9, 0.05, 0.05]" : "[0.05, 0.9, 0.05]") + "}, ";
  Shot shot(bodies_only("[" + bodies.substr(0, bodies.size() - 2) + "]"), "[render.background]", "320x180");
  const Picture picture = shot.frame();
  const Vector3d camera(0, 0.5, 0.6);
  const auto nearest = [&](int x, int y) {  // index of the ball; -1: none
    const double slope = std::tan(30 * M_PI / 180) / 90;
    const Vector3d ray = Vector3d((x + 0.5 - 160) * slope, (y + 0.5 - 90) * slope, -1).normalized();
    int found = -1;
    double distance = 1e30;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Vector3d to_center = balls[i].place - camera;
      const double along = to_center.dot(ray), room = balls[i].radius * balls[i].radius - (to_center - along * ray).squaredNorm();
      if (room < 0 || along - std::sqrt(room) >= distance) continue;
      distance = along - std::sqrt(room);
      found = static_cast<int>(i);
    }
    return found;
  };
  int checked = 0, wrong = 0;
  for (int y = 1; y < 179; ++y)
    for (int x = 1; x < 319; ++x) {
      const int ball = nearest(x, y);
      if (nearest(x - 1, y) != ball || nearest(x + 1, y) != ball || nearest(x, y - 1) != ball || nearest(x, y + 1) != ball)
        continue;
      const Pixel pixel = picture.at(x, y);
      const bool right = ball < 0 ? is_sky(pixel) : balls[static_cast<std::size_t>(ball)].red ? is_red(pixel) : is_green(pixel);
      ++checked;
      wrong += right ? 0 : 1;
    }
  CHECK(checked > 20000);
  CHECK(wrong == 0);
}
