#include "graph/pipeline.h"

#include <fmt/format.h>

#include <functional>
#include <map>
#include <optional>
#include <set>

#include "config/links.h"
#include "config/nearest.h"
#include "config/reader.h"
#include "graph/format_version.h"
#include "graph/merge.h"
#include "graph/stage_file.h"
#include "graph/stage_uses.h"

namespace firn::graph {
namespace {

using config::Diagnostics;
using config::Entry;
using config::Node;
using config::Reader;

void each_use(PipelineSpec& pipeline, const std::function<void(StageUse&)>& visit) {
  for (std::vector<Item>* phase : {&pipeline.setup, &pipeline.step, &pipeline.frame}) graph::each_use(*phase, visit);
}

// The uses that a name from the command line means: one by its label, or all uses of a stage.
std::vector<StageUse*> named(PipelineSpec& pipeline, const std::string& name) {
  std::vector<StageUse*> found;
  each_use(pipeline, [&](StageUse& use) {
    if (use.label == name || use.stage == name) found.push_back(&use);
  });
  return found;
}

std::vector<std::string> labels(PipelineSpec& pipeline) {
  std::vector<std::string> list;
  each_use(pipeline, [&](StageUse& use) { list.push_back(use.label); });
  return list;
}

// Stages that are files go by the names that their heads give them.
void read_stage_files(PipelineSpec& pipeline, Diagnostics& diagnostics) {
  std::map<std::string, std::optional<StageSpec>> by_path;
  std::map<std::string, std::string> path_of;  // by name
  each_use(pipeline, [&](StageUse& use) {
    if (!is_stage_file(use.stage)) return;
    const std::string path = use.stage;
    if (!by_path.contains(path)) {
      std::error_code error;  // names that are too long, circles of links
      if (std::filesystem::is_regular_file(path, error))
        by_path[path] = read_stage_file(path, diagnostics);
      else
        diagnostics.error(use.place, fmt::format("no such stage file: '{}'{}", path, config::circle_hint(path)));
    }
    const std::optional<StageSpec>& spec = by_path[path];
    if (!spec) {
      use.wanted = false;
      return;
    }
    const auto [first, is_new] = path_of.emplace(spec->name, path);
    if (!is_new && first->second != path)
      diagnostics.error(use.place, fmt::format("'{}' and '{}' both call their stage '{}'", first->second, path, spec->name));
    if (use.label == use.stage) use.label = spec->name;
    use.stage = spec->name;
    pipeline.stage_files.emplace(spec->name, *spec);
  });
}

void make_labels_unique(PipelineSpec& pipeline, Diagnostics& diagnostics) {
  std::set<std::string> taken;
  std::map<std::string, int> next;  // number of a label
  each_use(pipeline, [&](StageUse& use) {
    const std::string wanted = use.label;
    if (wanted != use.stage && taken.contains(wanted))
      diagnostics.error(use.place, fmt::format("two stages are called '{}'", wanted));
    for (int& number = next.try_emplace(wanted, 2).first->second; !taken.insert(use.label).second; ++number)
      use.label = fmt::format("{}#{}", wanted, number);
  });
}

void apply_to_stage(PipelineSpec& pipeline, const config::Override& change, Diagnostics& diagnostics) {
  // Stage names have dots themselves: the longest leading part that names a stage counts.
  for (std::size_t length = change.path.size() - 1; length >= 1; --length) {
    std::string name = change.path[0];
    for (std::size_t i = 1; i < length; ++i) name += "." + change.path[i];
    const std::vector<StageUse*> uses = named(pipeline, name);
    if (uses.empty()) continue;
    if (length + 1 != change.path.size()) {
      diagnostics.error(change.place, fmt::format("write {}.<parameter>=<value>", name));
      return;
    }
    for (StageUse* use : uses)
      read_option({change.path.back(), change.place, change.value}, pipeline.parameters, *use, diagnostics);
    return;
  }
  std::string stage = change.path[0];
  for (std::size_t i = 1; i + 1 < change.path.size(); ++i) stage += "." + change.path[i];
  diagnostics.error(change.place,
                    fmt::format("no stage '{}' in this pipeline{}", stage, config::suggestion(stage, labels(pipeline))));
}

void set_parameters(Node& root, const Edits& edits, PipelineSpec& pipeline, Diagnostics& diagnostics) {
  Node& parameters = pipeline.parameters;
  parameters.kind = Node::Kind::map;
  if (const Node* given = root.find("parameters")) {
    if (given->kind == Node::Kind::map)
      parameters = *given;
    else if (given->kind != Node::Kind::null)
      diagnostics.error(given->place, fmt::format("parameters must be a map of names to values, not {}", describe(*given)));
  }
  constexpr std::size_t most_parameters = 1000;
  if (parameters.entries.size() > most_parameters) {
    diagnostics.error(parameters.entries[most_parameters].place, fmt::format("more than {} parameters", most_parameters));
    parameters.entries.resize(most_parameters);
  }
  for (const config::Override& change : edits.set) {
    if (change.path.size() != 1 || change.path[0] == "scene") continue;
    if (Node* value = parameters.find(change.path[0])) {
      *value = change.value;
      value->place = change.place;
      continue;
    }
    std::vector<std::string> known;
    for (const Entry& e : parameters.entries) known.push_back(e.key);
    diagnostics.error(change.place, known.empty()
                                        ? fmt::format("no parameter '{}': this pipeline has no parameters of its own; write "
                                                      "<stage>.<parameter>=<value> or scene.<key>=<value>",
                                                      change.path[0])
                                        : fmt::format("no parameter '{}' in this pipeline{}", change.path[0],
                                                      config::suggestion(change.path[0], known)));
  }
}

}  // namespace

PipelineSpec load_pipeline(const std::filesystem::path& file, const Edits& edits, Diagnostics& diagnostics) {
  PipelineSpec pipeline;
  pipeline.file = file.string();
  Node root = load_merged(file, diagnostics);
  if (root.kind == Node::Kind::null && diagnostics.has_errors()) return pipeline;
  if (root.find("step") == nullptr && (root.find("domain") != nullptr || root.find("snow") != nullptr)) {
    diagnostics.error(root.place, "this is a scene, not a pipeline: name a pipeline, and this file by --scene");
    return pipeline;
  }
  for (const auto& [group, stages] : edits.replace) replace_group(root, group, stages, stages.place, diagnostics);
  set_parameters(root, edits, pipeline, diagnostics);
  for (const char* phase : phase_names)
    if (Node* list = root.find(phase)) config::substitute(*list, pipeline.parameters, diagnostics);

  Reader reader(root, "a pipeline", diagnostics);
  read_version(reader, "a pipeline");
  pipeline.name = reader.text("name", file.stem().string());
  pipeline.doc = reader.text("doc", "");
  pipeline.scene = reader.text("scene", "");
  if (const Node* scene = root.find("scene")) pipeline.scene_place = scene->place;
  reader.find("parameters");
  for (auto [name, list] : {std::pair{"setup", &pipeline.setup}, {"step", &pipeline.step}, {"frame", &pipeline.frame}})
    if (const Node* node = reader.find(name)) read_items(*node, name, pipeline.parameters, *list, diagnostics);
  if (!edits.frame.items.empty()) read_items(edits.frame, "frame", pipeline.parameters, pipeline.frame, diagnostics);
  reader.find("include");
  reader.find("replace");
  reader.finish();
  if (root.kind == Node::Kind::map && pipeline.setup.empty() && pipeline.step.empty() && pipeline.frame.empty() &&
      !diagnostics.has_errors())
    diagnostics.error(root.place, "the pipeline has no stages: list them under 'setup', 'step' or 'frame'");

  read_stage_files(pipeline, diagnostics);
  make_labels_unique(pipeline, diagnostics);
  for (const config::Override& change : edits.set)
    if (change.path.size() > 1 && change.path[0] != "scene") apply_to_stage(pipeline, change, diagnostics);
  for (const std::string& name : edits.disable) {
    const std::vector<StageUse*> uses = named(pipeline, name);
    if (uses.empty())
      diagnostics.error({"--disable " + name, 0, 0},
                        fmt::format("no stage '{}' in this pipeline{}", name, config::suggestion(name, labels(pipeline))));
    for (StageUse* use : uses) use->enabled = false;
  }
  each_use(pipeline, [](StageUse& use) { use.enabled = use.enabled && use.wanted; });
  return pipeline;
}

}  // namespace firn::graph
