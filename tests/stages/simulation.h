#pragma once

// A shipped pipeline on a scene, ready to step. Frames are left out: nothing is drawn.

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "app/load.h"
#include "tests/stages/random_snow.h"

namespace firn::test {

inline std::string pipeline_file(const std::string& name) { return std::string(FIRN_SOURCE_DIR) + "/pipelines/" + name + ".yaml"; }

// A scene text as a file that lives as long as this.
struct SceneFile {
  explicit SceneFile(const std::string& text)
      : path((std::filesystem::temp_directory_path() / ("firn-scene-" + std::to_string(getpid()) + ".yaml")).string()) {
    std::ofstream(path) << text;
  }
  ~SceneFile() { std::filesystem::remove(path); }
  std::string path;
};

// Lists of cells and blocks are made as these come, in another order in every run.
inline bool repeats(const graph::Plan& plan, const graph::PlannedBuffer& buffer) {
  for (const graph::PlannedStage& stage : plan.stages)
    for (std::size_t p = 0; p < stage.buffers.size(); ++p)
      if (stage.buffers[p] == plan.buffer(buffer.name) && !stage.spec.ports[p].repeatable) return false;
  return true;
}

struct Simulation {
  Simulation(const std::string& pipeline, const std::string& scene_text, std::vector<std::string> set = {},
             bool barriers_all = false)
      : scene(scene_text) {
    app::Inputs inputs;
    inputs.pipeline = pipeline_file(pipeline);
    inputs.scene = scene.path;
    inputs.set = std::move(set);
    inputs.share_memory = false;  // tests look at scratch buffers too
    loaded = app::load(inputs, "");
    execution = std::make_unique<execution::Execution>(device(), loaded.plan, loaded.registry,
                                                       execution::Options{shader_folders(), barriers_all, false});
    execution->setup();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      execution->clock().dt = *loaded.problem->scene.time.dt;
      execution->step();
    }
    execution->check_faults();
  }
  [[nodiscard]] std::vector<float> floats(const std::string& buffer) const {
    const graph::PlannedBuffer& planned = loaded.plan.buffers.at(static_cast<std::size_t>(loaded.plan.buffer(buffer)));
    const std::vector<std::byte> bytes = graph::unpadded(planned.type, execution->read(buffer));
    std::vector<float> values(bytes.size() / 4);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  [[nodiscard]] std::vector<Vector3d> vectors(const std::string& buffer) const {
    const std::vector<float> values = floats(buffer);
    std::vector<Vector3d> result;
    for (std::size_t i = 0; i < values.size(); i += 3) result.emplace_back(values[i], values[i + 1], values[i + 2]);
    return result;
  }
  [[nodiscard]] Vector3d momentum() const {
    const std::vector<float> mass = floats("mass");
    const std::vector<Vector3d> velocity = vectors("velocity");
    Vector3d sum = Vector3d::Zero();
    for (std::size_t p = 0; p < mass.size(); ++p) sum += static_cast<double>(mass[p]) * velocity[p];
    return sum;
  }

  SceneFile scene;
  app::Loaded loaded;
  std::unique_ptr<execution::Execution> execution;
};

struct Variant {
  const char* pipeline;
  const char* kernel;
  const char* accumulate;  // empty: the pipeline has no such choice
};
inline const Variant variants[] = {
    {"mpm_thesis", "cubic", "fixed"},     {"mpm_thesis", "cubic", "float"}, {"mpm_thesis", "quadratic", "fixed"},
    {"mpm_thesis", "quadratic", "float"}, {"mpm_snow", "cubic", ""},        {"mpm_snow", "quadratic", ""}};

inline std::vector<std::string> settings(const Variant& variant) {
  std::vector<std::string> set{std::string("kernel=") + variant.kernel};
  if (*variant.accumulate != 0) set.push_back(std::string("accumulate=") + variant.accumulate);
  return set;
}

}  // namespace firn::test
