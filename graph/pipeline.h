#pragma once

// The editable form of a pipeline: the file as read, every node with its place.

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "config/node.h"
#include "graph/spec.h"

namespace firn::graph {

using config::Place;

struct Binding {
  std::string port, buffer;
  Place place;
};

struct StageUse {
  std::string stage;  // name in the registry or in PipelineSpec::stage_files
  std::string label;  // unique in the pipeline: the stage's name, from the second on with #2, #3, or what `as:` says
  Place place;
  std::vector<config::Entry> parameters;
  std::vector<Binding> bindings;
  std::int64_t every = 1;
  bool wanted = true;   // `when` holds
  bool enabled = true;  // and it is wanted; others are checked, but not planned
};

struct Until {
  std::string buffer;  // one float; the loop ends when it is below the limit
  double below = 0;
  Place place;
};

struct Item;
struct RepeatUse {
  Place place;
  std::int64_t max = 1;
  std::vector<Until> until;  // none or one
  std::vector<Item> stages;
};
struct Item {
  std::variant<StageUse, RepeatUse> what;
};

struct PipelineSpec {
  std::string file, name, doc;
  std::string scene;  // path of the default scene, resolved against the file that names it; empty: none
  Place scene_place;
  config::Node parameters;  // with overrides applied
  std::vector<Item> setup, step, frame;
  std::map<std::string, StageSpec> stage_files;  // by name: stages that are .comp files
};

// Changes from the command line.
struct Edits {
  std::vector<config::Override> set;  // k=4, stage.param=value, stage.every=2; paths that begin with "scene" are not for us
  std::vector<std::string> disable;   // labels
  std::vector<std::pair<std::string, config::Node>> replace;  // group -> list of stages
  config::Node frame = {};                                    // list of stages at the end of `frame`
};

// Reads a pipeline file: includes, groups and their replacements, ${parameters}, stages that are files, edits. Everything wrong
// goes to `diagnostics`.
PipelineSpec load_pipeline(const std::filesystem::path& file, const Edits& edits, config::Diagnostics& diagnostics);

}  // namespace firn::graph
