#pragma once

// From the command line to a plan: what run, check and others share.

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "graph/compile.h"
#include "graph/pipeline.h"
#include "stages/forms.h"
#include "stages/problem.h"
#include "stages/register.h"

namespace firn::app {

struct Inputs {
  std::string pipeline, scene;  // files; an empty scene is the pipeline's own
  std::vector<std::string> set, disable, replace;
  std::vector<std::string> exports;  // particles:vtp (app/export.h)
  std::string image = "1280x720";
  std::vector<std::string> keep;  // buffers whose contents are wanted after a step, as dumps are
  bool share_memory = true;
  std::string repeats = "auto";  // who finds their ends: host, device; auto: see plan_for()
  double memory = 0;             // bytes that particles and grid may take; 0: what this machine has
};
// The options of `inputs`, the same for every verb that takes a pipeline.
void add_inputs(CLI::App& verb, Inputs& inputs);

struct Loaded {
  std::string pipeline_file, scene_file;
  config::Node scene_node;  // as read, with --set applied
  std::shared_ptr<const stages::Problem> problem;
  graph::Registry registry;
  graph::PipelineSpec pipeline;
  graph::Plan plan;
  config::Diagnostics diagnostics;  // warnings only, once loaded
};

// Throws config::InputError with everything that is wrong with pipeline and scene. `output`: folder for what stages write.
Loaded load(const Inputs& inputs, const std::string& output);

// Plans again where the device calls for another plan than load() made, which is a software renderer's: others take other forms of
// kernels, and are not to be waited for at the end of a repeat, which software renderers read back in no time. The reason for the
// forms.
std::string plan_for(Loaded& loaded, const Inputs& inputs, const stages::DeviceProfile& device);

// The parts of load() that other verbs need by themselves; errors go to `diagnostics`.
std::vector<config::Override> read_overrides(const std::vector<std::string>& words, config::Diagnostics& diagnostics);  // --set
// The scene of a file with those of `changes` that begin with "scene"; nothing where anything is wrong with it. `memory`: as above.
std::shared_ptr<const stages::Problem> load_problem(const std::string& file, const std::vector<config::Override>& changes,
                                                    stages::Image image, const std::string& output, config::Node& node,
                                                    config::Diagnostics& diagnostics, double memory = 0);
// A scene that any pipeline can be checked against when its own is wrong, so that the errors of both are told at once. Nothing in
// it but that every domain and constant has a value.
scene::Scene nominal_scene();

// `name` as given, else below the folders of pipelines that come with Firn, with or without .yaml. Unchanged where nothing is
// found.
std::string find_input(const std::string& name, const std::string& folder);

// Where shaders are: FIRN_DATA, share/firn beside the program's own folder, or the source tree it was built from.
std::vector<std::filesystem::path> data_folders();
std::vector<std::filesystem::path> shader_folders();

// Errors and warnings, one per line, to stderr.
void print(const config::Diagnostics& diagnostics);

}  // namespace firn::app
