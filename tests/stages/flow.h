#pragma once

// A shipped pipeline on a scene whose particles come and go, with its frames.

#include "app/arrays.h"
#include "scene/emission.h"
#include "tests/stages/simulation.h"

namespace firn::test {

// A lump on the ground, a snowfall of 640 particles a second beside it, and a gun of 1280; fps 100 with 5 steps a frame.
inline const std::string snow = "snow: [{box: {min: [0.3, 0.2, 0.3], max: [0.5, 0.35, 0.7]}, material: light, per_cell: 8}]\n";
inline const std::string emitters =
    "emitters:\n"
    "  - {snowfall: {center: [0.8, 0.8, 0.5], size: [0.5, 0.4], rate: 5, velocity: [0, -2, 0]}, material: light, from: 0.01}\n"
    "  - {gun: {position: [0.3, 0.6, 0.5], direction: [1, 0.3, 0], speed: 4, spread: 5, radius: 0.05, rate: 2}, material: light}\n"
    "max_particles: 1000\n";

inline std::string scene_text(const std::string& more) {
  return R"(firn: 1
name: come_and_go
time: {dt: 2.0e-3, fps: 100, end: 1}
domain: {min: [0, 0, 0], max: [1.5, 1, 1], cell: 0.05}
materials: {light: {preset: new_snow, density: 100, young: 1.0e4}}
bodies: [{plane: {point: [0, 0.2, 0], normal: [0, 1, 0]}, friction: 0.5}]
)" + more;
}

// Frames without pictures. `more` is a whole scene, or what comes after scene_text.
struct Flow {
  Flow(const std::string& pipeline, const std::string& more, std::vector<std::string> set = {})
      : scene(more.starts_with("firn:") ? more : scene_text(more)) {
    app::Inputs inputs;
    inputs.pipeline = pipeline_file(pipeline);
    inputs.scene = scene.path;
    inputs.set = std::move(set);
    inputs.disable = {"render.shadow_map", "render.background", "render.particles", "io.frames", "io.video"};
    loaded = app::load(inputs, "");
    execution = std::make_unique<execution::Execution>(device(), loaded.plan, loaded.registry,
                                                       execution::Options{shader_folders(), false, false});
    execution->setup();
    execution->frame();
  }
  void frames(int count) {
    for (int i = 0; i < count * 5; ++i) {
      graph::Clock& clock = execution->clock();
      clock.dt = *loaded.problem->scene.time.dt;
      execution->step();
      clock.time = static_cast<double>(clock.step) * clock.dt;
      if (clock.step % 5 == 0) execution->frame();
    }
    execution->check_faults();
  }
  [[nodiscard]] std::uint64_t count() const { return execution->plan().environment.domains.at("particles").count; }
  [[nodiscard]] std::uint64_t due() const {
    std::uint64_t sum = loaded.problem->particles.mass.size();
    for (const scene::Emitter& emitter : loaded.problem->scene.emitters)
      sum += scene::emitted_until(loaded.problem->scene, emitter, execution->clock().time);
    return sum;
  }
  [[nodiscard]] std::vector<float> floats(const std::string& buffer) const {
    const std::vector<std::byte> bytes = app::read_buffer(*execution, buffer);
    std::vector<float> values(bytes.size() / 4);
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  [[nodiscard]] double total(const std::string& buffer) const {
    double sum = 0;
    if (loaded.plan.buffer(buffer) >= 0)
      for (const float value : floats(buffer)) sum += static_cast<double>(value);
    return sum;
  }
  // What repeats from run to run.
  [[nodiscard]] std::map<std::string, std::vector<std::byte>> state() const {
    std::map<std::string, std::vector<std::byte>> contents;
    for (const graph::PlannedBuffer& buffer : execution->plan().buffers)
      if (buffer.lifetime == graph::Lifetime::state && !buffer.texture && repeats(loaded.plan, buffer) &&
          graph::base_domain(buffer.domain) == "particles")
        contents[buffer.name] = execution->read(buffer.name);
    return contents;
  }

  SceneFile scene;
  app::Loaded loaded;
  std::unique_ptr<execution::Execution> execution;
};

}  // namespace firn::test
