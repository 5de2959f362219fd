#include "graph/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "config/nearest.h"
#include "config/reader.h"

namespace firn::graph {
namespace {

using config::Diagnostics;
using config::Entry;
using config::Node;
using config::Reader;

constexpr const char* phase_names[] = {"setup", "step", "frame"};

std::string beside(const Place& place, const std::string& path) {
  return (std::filesystem::path(place.file).parent_path() / path).lexically_normal().string();
}

Entry& entry(Node& map, const std::string& key, const Place& place) {
  for (Entry& e : map.entries)
    if (e.key == key) return e;
  map.kind = Node::Kind::map;
  map.entries.push_back({key, place, {}});
  return map.entries.back();
}

// Calls `visit` for every list of stages: the phases and, below them, those of groups and repeats.
void each_list(Node& list, const std::function<void(Node& item, const std::string& group)>& visit) {
  for (Node& item : list.items) {
    const Node* group = item.find("group");
    if (group != nullptr) visit(item, group->scalar);
    if (Node* inner = item.find("stages")) each_list(*inner, visit);
  }
}

void replace_group(Node& root, const std::string& group, const Node& stages, const Place& place, Diagnostics& diagnostics) {
  std::vector<std::string> known;
  bool found = false;
  for (const char* phase : phase_names)
    if (Node* list = root.find(phase))
      each_list(*list, [&](Node& item, const std::string& name) {
        known.push_back(name);
        if (name != group) return;
        found = true;
        entry(item, "stages", place).value = stages;
      });
  if (!found)
    diagnostics.error(place, known.empty() ? fmt::format("no group '{}' to replace: the pipeline has no groups", group)
                                           : fmt::format("no group '{}' to replace{}", group, config::suggestion(group, known)));
}

// The file with what it includes: its own keys win, `parameters` are merged, `replace` swaps the stages of groups.
Node load_merged(const std::filesystem::path& file, std::vector<std::string> chain, Diagnostics& diagnostics) {
  Node own = config::load(file, diagnostics);
  if (Node* scene = own.find("scene"); scene && scene->kind == Node::Kind::scalar)
    scene->scalar = beside(scene->place, scene->scalar);
  const Node* include = own.find("include");
  Node merged = own;
  if (include != nullptr) {
    std::erase_if(merged.entries, [](const Entry& e) { return e.key == "include"; });
    const auto path = config::read_text(*include, "include", diagnostics);
    chain.push_back(std::filesystem::weakly_canonical(file).string());
    const std::string other = path ? beside(include->place, *path) : "";
    if (path && std::ranges::find(chain, std::filesystem::weakly_canonical(other).string()) != chain.end()) {
      diagnostics.error(include->place, fmt::format("'{}' includes itself, directly or through others", *path));
    } else if (path && !std::filesystem::is_regular_file(other)) {
      diagnostics.error(include->place, fmt::format("no such file: '{}'", other));
    } else if (path) {
      Node base = load_merged(other, chain, diagnostics);
      for (Entry& e : merged.entries) {
        Node& target = entry(base, e.key, e.place).value;
        if (e.key == "parameters" && target.kind == Node::Kind::map && e.value.kind == Node::Kind::map) {
          for (Entry& parameter : e.value.entries) entry(target, parameter.key, parameter.place).value = parameter.value;
        } else {
          target = e.value;
        }
      }
      base.place = own.place;
      merged = std::move(base);
    }
  }
  if (const Node* replace = merged.find("replace")) {
    if (replace->kind != Node::Kind::map)
      diagnostics.error(replace->place,
                        fmt::format("replace must be a map of groups to lists of stages, not {}", describe(*replace)));
    const std::vector<Entry> groups = replace->entries;
    for (const Entry& group : groups) replace_group(merged, group.key, group.value, group.place, diagnostics);
    std::erase_if(merged.entries, [](const Entry& e) { return e.key == "replace"; });
  }
  return merged;
}

class PipelineReader {
 public:
  explicit PipelineReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void items(const Node& list, const std::string& what, std::vector<Item>& items) {
    if (list.kind == Node::Kind::null) return;
    if (list.kind != Node::Kind::sequence) {
      diagnostics_.error(list.place, fmt::format("{} must be a list of stages, not {}", what, describe(list)));
      return;
    }
    for (const Node& node : list.items) item(node, items);
  }

 private:
  void item(const Node& node, std::vector<Item>& items) {
    if (node.kind == Node::Kind::scalar) {
      StageUse use;
      use.stage = use.label = node.scalar;
      use.place = node.place;
      items.push_back({use});
    } else if (node.find("repeat") != nullptr) {
      repeat(node, items);
    } else if (node.find("group") != nullptr) {
      Reader reader(node, "a group", diagnostics_);
      reader.required_text("group");
      if (const Node* stages = reader.require("stages")) this->items(*stages, "stages", items);
      reader.finish();
    } else if (node.find("stage") != nullptr) {
      stage_by_key(node, items);
    } else if (node.kind == Node::Kind::map && node.entries.size() == 1) {
      const Entry& only = node.entries.front();
      StageUse use;
      use.stage = use.label = only.key;
      use.place = only.place;
      options(only.value, {}, use);
      items.push_back({std::move(use)});
    } else if (node.kind == Node::Kind::map && node.entries.size() > 1) {
      diagnostics_.error(
          node.entries[1].place,
          fmt::format("'{}' beside '{}': one stage per list entry; options belong in the braces behind its name: '- {}: "
                      "{{{}: ...}}'",
                      node.entries[1].key, node.entries[0].key, node.entries[0].key, node.entries[1].key));
    } else {
      diagnostics_.error(
          node.place,
          fmt::format("expected a stage's name, '- stage: {{parameter: value}}', a repeat or a group, not {}", describe(node)));
    }
  }

  void stage_by_key(const Node& node, std::vector<Item>& items) {
    const Node& stage = *node.find("stage");
    const auto text = config::read_text(stage, "stage", diagnostics_);
    if (!text) return;
    StageUse use;
    use.stage = use.label = text->find('/') == std::string::npos ? *text : beside(stage.place, *text);
    use.place = stage.place;
    options(node, {"stage"}, use);
    items.push_back({std::move(use)});
  }

  void options(const Node& map, const std::set<std::string>& skip, StageUse& use) {
    if (map.kind == Node::Kind::null) return;
    if (map.kind != Node::Kind::map) {
      diagnostics_.error(
          map.place, fmt::format("the options of {} must be a map such as {{parameter: value}}, not {}", use.stage, describe(map)));
      return;
    }
    for (const Entry& e : map.entries) {
      if (!skip.contains(e.key)) option(e, use);
    }
  }

 public:
  // One option of a stage: bind, every, enable, as; everything else is one of its parameters.
  void option(const Entry& e, StageUse& use) {
    if (e.key == "bind") {
      bind(e.value, use);
    } else if (e.key == "every") {
      use.every = config::read_integer(e.value, "every", {.min = 1, .max = 1e9}, diagnostics_).value_or(1);
    } else if (e.key == "enable") {
      use.enabled = config::read_boolean(e.value, "enable", diagnostics_).value_or(true);
    } else if (e.key == "as") {
      use.label = config::read_text(e.value, "as", diagnostics_).value_or(use.label);
    } else {
      const auto same = std::ranges::find(use.parameters, e.key, &Entry::key);
      if (same != use.parameters.end())
        *same = e;
      else
        use.parameters.push_back(e);
    }
  }

 private:
  void bind(const Node& map, StageUse& use) {
    if (map.kind != Node::Kind::map) {
      diagnostics_.error(map.place,
                         fmt::format("bind must be a map of ports to buffers such as {{port: buffer}}, not {}", describe(map)));
      return;
    }
    for (const Entry& e : map.entries)
      if (const auto buffer = config::read_text(e.value, "the buffer of port " + e.key, diagnostics_))
        use.bindings.push_back({e.key, *buffer, e.place});
  }

  void repeat(const Node& node, std::vector<Item>& items) {
    Reader reader(node, "a repeat", diagnostics_);
    RepeatUse use;
    use.place = node.place;
    const config::Range turns{.min = 1, .max = 1e6};
    const Node* how = reader.find("repeat");
    if (how->kind == Node::Kind::map) {
      Reader options(*how, "repeat", diagnostics_);
      if (const Node* max = options.require("max")) use.max = config::read_integer(*max, "max", turns, diagnostics_).value_or(1);
      if (const Node* until = options.find("until")) {
        Reader limit(*until, "until", diagnostics_);
        Until condition;
        condition.place = until->place;
        condition.buffer = limit.required_text("buffer");
        condition.below = limit.required_number("below");
        limit.finish();
        use.until.push_back(condition);
      }
      options.finish();
    } else {
      use.max = config::read_integer(*how, "repeat", turns, diagnostics_).value_or(1);
    }
    if (const Node* stages = reader.require("stages")) this->items(*stages, "stages", use.stages);
    reader.finish();
    items.push_back({std::move(use)});
  }

  Diagnostics& diagnostics_;
};

void each_use(std::vector<Item>& items, const std::function<void(StageUse&)>& visit) {
  for (Item& item : items) {
    if (auto* use = std::get_if<StageUse>(&item.what)) visit(*use);
    if (auto* repeat = std::get_if<RepeatUse>(&item.what)) each_use(repeat->stages, visit);
  }
}

void each_use(PipelineSpec& pipeline, const std::function<void(StageUse&)>& visit) {
  for (std::vector<Item>* phase : {&pipeline.setup, &pipeline.step, &pipeline.frame}) each_use(*phase, visit);
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

void make_labels_unique(PipelineSpec& pipeline, Diagnostics& diagnostics) {
  std::set<std::string> taken;
  each_use(pipeline, [&](StageUse& use) {
    const std::string wanted = use.label;
    if (wanted != use.stage && taken.contains(wanted))
      diagnostics.error(use.place, fmt::format("two stages are called '{}'", wanted));
    for (int number = 2; !taken.insert(use.label).second; ++number) use.label = fmt::format("{}#{}", wanted, number);
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
    PipelineReader reader(diagnostics);
    for (StageUse* use : uses) reader.option({change.path.back(), change.place, change.value}, *use);
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
  Node root = load_merged(file, {}, diagnostics);
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
  if (reader.integer("firn", 0, {.min = 1, .max = 1}) == 0 && root.kind == Node::Kind::map && !reader.has("firn"))
    diagnostics.error(root.place, "missing key 'firn': a pipeline begins with 'firn: 1', the version of its format");
  pipeline.name = reader.text("name", file.stem().string());
  pipeline.doc = reader.text("doc", "");
  pipeline.scene = reader.text("scene", "");
  if (const Node* scene = root.find("scene")) pipeline.scene_place = scene->place;
  reader.find("parameters");
  PipelineReader items(diagnostics);
  for (auto [name, list] : {std::pair{"setup", &pipeline.setup}, {"step", &pipeline.step}, {"frame", &pipeline.frame}})
    if (const Node* node = reader.find(name)) items.items(*node, name, *list);
  reader.find("include");
  reader.find("replace");
  reader.finish();
  if (root.kind == Node::Kind::map && pipeline.setup.empty() && pipeline.step.empty() && pipeline.frame.empty() &&
      !diagnostics.has_errors())
    diagnostics.error(root.place, "the pipeline has no stages: list them under 'setup', 'step' or 'frame'");

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
  return pipeline;
}

}  // namespace firn::graph
