#include "app/one_stage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <set>

#include "app/load.h"
#include "config/nearest.h"
#include "graph/stage_file.h"

namespace firn::app {

OneStage find_stage(const std::string& word, const std::string& verb, const graph::Registry& registry) {
  OneStage stage;
  stage.place = {verb + " " + word, 0, 0};
  config::Diagnostics diagnostics;
  if (graph::is_stage_file(word)) {
    const std::filesystem::path file = std::filesystem::absolute(find_input(word, "pipelines")).lexically_normal();
    if (auto spec = graph::read_stage_file(file, diagnostics)) {
      stage.name = spec->name;
      stage.spec = std::make_shared<graph::StageSpec>(*spec);
      stage.files.emplace(stage.name, std::move(*spec));
    }
  } else if (const graph::StageType* type = registry.find(word)) {
    stage.name = word;
    stage.spec = std::make_shared<graph::StageSpec>(type->spec);
  } else {
    diagnostics.error(stage.place, fmt::format("there is no stage '{}'{}", word, config::suggestion(word, registry.names())));
  }
  config::throw_if_errors(diagnostics);
  return stage;
}

graph::PipelineSpec pipeline_of(const OneStage& stage, const std::vector<config::Entry>& parameters,
                                const std::function<bool(const graph::Port&)>& wanted) {
  graph::StageUse use;
  use.stage = use.label = stage.name;
  use.place = stage.place;
  use.parameters = parameters;
  // Of ports by the same name one exists, by the parameters.
  std::set<std::string> bound;
  for (const graph::Port& port : stage.spec->ports)
    if (port.optional && port.when.name.empty() && wanted(port) && bound.insert(port.name).second)
      use.bindings.push_back({port.name, port.name, stage.place});
  graph::PipelineSpec result;
  result.file = result.name = stage.place.file;
  result.stage_files = stage.files;
  result.step.push_back({use});
  return result;
}

graph::Environment known_environment() { return stages::environment(*stages::make_problem(nominal_scene(), {}, "")); }

graph::Environment sketch_environment(const OneStage& stage, const graph::Environment& known,
                                      const std::function<bool(const graph::Port&)>& wanted) {
  graph::Environment environment = known;
  for (const graph::Port& port : stage.spec->ports) {
    if (const std::string base = graph::base_domain(port.domain); !base.empty())
      environment.domains.emplace(base, graph::DomainSize{1, 1, 1, {}});
    if (!port.optional || wanted(port)) environment.provided.insert(port.name);
  }
  for (const std::string& constant : stage.spec->constants)
    if (environment.constant(constant) == nullptr)
      environment.constants.push_back({constant, graph::ElementType::float1, 0.0, "1", ""});
  return environment;
}

std::vector<config::Entry> stage_parameters(const std::vector<config::Override>& changes, const std::string& stage) {
  std::vector<config::Entry> parameters;
  for (const config::Override& change : changes) {
    if (change.path.front() == "scene") continue;
    std::string key = fmt::format("{}", fmt::join(change.path, "."));
    if (key.starts_with(stage + ".")) key.erase(0, stage.size() + 1);
    parameters.push_back({key, change.place, change.value});
  }
  return parameters;
}

}  // namespace firn::app
