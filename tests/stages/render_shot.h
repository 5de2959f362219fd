#pragma once

// Pictures of small scenes, for tests of the stages that draw and of those that write pictures.

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "app/load.h"
#include "tests/graph/folder.h"
#include "tests/stages/harness.h"

namespace firn::test {

using Pixel = std::array<int, 3>;
inline int brightness(const Pixel& pixel) { return pixel[0] + pixel[1] + pixel[2]; }

struct Picture {
  int width = 0, height = 0;
  std::vector<std::byte> rgba;  // row 0 at the bottom

  [[nodiscard]] Pixel at(int x, int y) const {
    const std::size_t first = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {static_cast<int>(rgba.at(first)), static_cast<int>(rgba.at(first + 1)), static_cast<int>(rgba.at(first + 2))};
  }
  bool operator==(const Picture&) const = default;
};

// A scene with this camera, sun and bodies, and a ball of snow of radius 0.1 m at `snow`; no gravity to speak of, as nothing moves.
struct SceneText {
  std::string bodies = "[]";
  std::string camera = "{from: [0, 0.5, 4], to: [0, 0.5, 0], fov: 40}";
  std::string sun = "[0, -1, 0]";
  std::string snow = "[0, 0.5, 0]";
  std::string color = "[1, 1, 1]";

  [[nodiscard]] std::string text() const {
    return "firn: 1\nname: shot\ntime: {dt: 1.0e-4, fps: 25, end: 1}\n"
           "domain: {min: [-1, -1, -1], max: [1, 1, 1], cell: 0.05}\n"
           "materials: {white: {preset: packed, color: " +
           color + "}}\nsnow:\n  - {sphere: {center: " + snow + ", radius: 0.1}, material: white, per_cell: 8}\nbodies: " + bodies +
           "\ncamera: " + camera + "\nlight: {sun: " + sun + "}\n";
  }
};

inline constexpr const char* draw_all = "[render.shadow_map, render.background, render.particles]";

// A scene set up under a pipeline that only draws.
class Shot {
 public:
  Shot(const SceneText& scene, const std::string& stages = draw_all, const std::string& image = "160x90",
       const std::string& output = "")
      : Shot(scene.text(), "[mpm.seed, bodies.place]", stages, image, output) {}

  Shot(const std::string& scene, const std::string& setup, const std::string& stages, const std::string& image,
       const std::string& output = "") {
    app::Inputs inputs;
    inputs.scene = folder_.write("scene.yaml", scene).string();
    inputs.pipeline = folder_.write("pipeline.yaml", "firn: 1\nname: draw\nsetup: " + setup + "\nframe: " + stages + "\n").string();
    inputs.image = image;
    loaded_ = app::load(inputs, output);
    execution_ =
        std::make_unique<execution::Execution>(device(), loaded_.plan, loaded_.registry, execution::Options{shader_folders()});
    execution_->setup();
  }

  Picture frame() {
    execution_->frame();
    return picture();
  }
  [[nodiscard]] Picture picture() const {
    const graph::DomainSize& size = loaded_.plan.environment.domains.at("image");
    return {size.width, size.height, execution_->read("image")};
  }

  // Where a place in the scene is seen, in pixels; for cameras that are not tilted.
  [[nodiscard]] std::pair<int, int> pixel_of(const scene::Vector3d& place) const {
    const scene::Camera& camera = loaded_.problem->scene.camera;
    const scene::Vector3d forward = (camera.to - camera.from).normalized();
    const scene::Vector3d right = forward.cross(scene::Vector3d::UnitY()).normalized();
    const scene::Vector3d up = right.cross(forward), seen = place - camera.from;
    const Picture size = picture();
    const double scale = 0.5 * size.height / std::tan(0.5 * camera.fov * M_PI / 180) / seen.dot(forward);
    return {static_cast<int>(std::floor(0.5 * size.width + scale * seen.dot(right))),
            static_cast<int>(std::floor(0.5 * size.height + scale * seen.dot(up)))};
  }
  Pixel at(const scene::Vector3d& place) const {
    const auto [x, y] = pixel_of(place);
    return picture().at(x, y);
  }

  [[nodiscard]] std::vector<float> read(const std::string& buffer) const {
    const std::vector<std::byte> bytes = graph::unpadded(type_of(buffer), execution_->read(buffer));
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  void write(const std::string& buffer, const std::vector<float>& values) {
    execution_->write(buffer, graph::padded(type_of(buffer), std::as_bytes(std::span(values))));
  }

  [[nodiscard]] execution::Execution& execution() { return *execution_; }
  [[nodiscard]] const app::Loaded& loaded() const { return loaded_; }

 private:
  [[nodiscard]] graph::ElementType type_of(const std::string& buffer) const {
    return loaded_.plan.buffers.at(static_cast<std::size_t>(loaded_.plan.buffer(buffer))).type;
  }

  Folder folder_;
  app::Loaded loaded_;
  std::unique_ptr<execution::Execution> execution_;
};

}  // namespace firn::test
