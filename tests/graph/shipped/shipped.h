#pragma once

// The pipelines that come with Firn, planned without a device.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "graph/compile.h"
#include "graph/pipeline.h"
#include "scene/scene.h"
#include "stages/problem.h"
#include "stages/register.h"

namespace firn::test {

inline std::filesystem::path source_folder() { return FIRN_SOURCE_DIR; }

// Paths below pipelines/, without the scenes.
inline std::vector<std::string> shipped_pipelines() {
  const std::filesystem::path root = source_folder() / "pipelines";
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string name = std::filesystem::relative(entry.path(), root).generic_string();
    if (name.ends_with(".yaml") && !name.starts_with("scenes/")) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

// One pipeline on its own scene, ready to be planned in many ways.
class Shipped {
 public:
  explicit Shipped(const std::string& name, const std::vector<std::string>& set = {}) {
    config::Diagnostics diagnostics;
    graph::Edits edits;
    for (const std::string& word : set) edits.set.push_back(config::parse_override(word, diagnostics));
    pipeline = graph::load_pipeline(source_folder() / "pipelines" / name, edits, diagnostics);
    const config::Node node = config::load(pipeline.scene, diagnostics);
    scene::Scene scene = scene::read_scene(node, diagnostics);
    config::throw_if_errors(diagnostics);
    problem_ = stages::make_problem(std::move(scene), {}, "out");
    registry_ = stages::all_stages(problem_);
    environment_ = stages::environment(*problem_);
  }

  [[nodiscard]] graph::Plan plan(const graph::PipelineSpec& spec, const graph::PlanOptions& options,
                                 config::Diagnostics& diagnostics) const {
    return graph::compile(spec, registry_, environment_, diagnostics, options);
  }
  [[nodiscard]] graph::Plan plan(const graph::PlanOptions& options) const {
    config::Diagnostics diagnostics;
    graph::Plan made = plan(pipeline, options, diagnostics);
    config::throw_if_errors(diagnostics);
    return made;
  }

  graph::PipelineSpec pipeline;

 private:
  std::shared_ptr<const stages::Problem> problem_;
  graph::Registry registry_;
  graph::Environment environment_;
};

}  // namespace firn::test
