#pragma once

// One stage by itself: found by its name or file, and sketched as a plan.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "graph/compile.h"

namespace firn::app {

struct OneStage {
  std::string name;
  std::shared_ptr<const graph::StageSpec> spec;
  std::map<std::string, graph::StageSpec> files;  // where it is a file: its spec once more
  config::Place place;                            // "try mpm.sort"
};

// `word` as in the registry, or the path of a .comp file. Throws config::InputError with the nearest name where there is none.
OneStage find_stage(const std::string& word, const std::string& verb, const graph::Registry& registry);

// A pipeline whose step is that stage. Optional ports are bound where `wanted`.
graph::PipelineSpec pipeline_of(const OneStage& stage, const std::vector<config::Entry>& parameters,
                                const std::function<bool(const graph::Port&)>& wanted);

// Domains and constants of a scene with nothing in it: their names, units and docs.
graph::Environment known_environment();

// `known` with every domain of the stage (one element, where it is not known), every constant, and `wanted` ports provided: in it
// the stage compiles, if its parameters are right.
graph::Environment sketch_environment(const OneStage& stage, const graph::Environment& known,
                                      const std::function<bool(const graph::Port&)>& wanted);

// The parameters of a stage among words of --set, with or without the stage's name before them.
std::vector<config::Entry> stage_parameters(const std::vector<config::Override>& changes, const std::string& stage);

}  // namespace firn::app
