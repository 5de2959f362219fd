// One stage: everything its spec says, who uses it, and the source of its kernels.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/load.h"
#include "app/one_stage.h"
#include "app/shipped.h"
#include "app/spec_text.h"
#include "app/verbs.h"
#include "graph/execution/kernels.h"
#include "graph/stage_uses.h"

namespace firn::app {
namespace {

struct InspectOptions {
  std::string stage;
  std::vector<std::string> set;
  bool glsl = false, json = false;
};

struct KernelText {
  std::string work, file, text;
};

// The whole source of every kernel and shader of the stage, as for a device without special abilities.
std::vector<KernelText> kernels(const OneStage& stage, const graph::Registry& registry, const std::vector<std::string>& set) {
  config::Diagnostics diagnostics;
  const auto every = [](const graph::Port&) { return true; };
  const std::vector<config::Entry> parameters = stage_parameters(read_overrides(set, diagnostics), stage.name);
  const graph::Plan plan = graph::compile(pipeline_of(stage, parameters, every), registry,
                                          sketch_environment(stage, known_environment(), every), diagnostics);
  config::throw_if_errors(diagnostics);
  std::vector<KernelText> texts;
  const std::vector<std::filesystem::path> folders = shader_folders();
  const std::vector<graph::Work>& work = plan.stages.front().spec.work;
  for (int w = 0; w < static_cast<int>(work.size()); ++w) {
    const graph::Work& one = work[static_cast<std::size_t>(w)];
    const auto add = [&](const std::string& file, gpu::ShaderKind kind) {
      if (!file.empty()) texts.push_back({describe(one), file, execution::kernel_source(plan, 0, w, file, kind, {}, folders).text});
    };
    if (const auto* dispatch = std::get_if<graph::Dispatch>(&one)) add(dispatch->kernel, gpu::ShaderKind::compute);
    if (const auto* draw = std::get_if<graph::Draw>(&one)) {
      add(draw->vertex, gpu::ShaderKind::vertex);
      add(draw->tessellation_control, gpu::ShaderKind::tessellation_control);
      add(draw->tessellation_evaluation, gpu::ShaderKind::tessellation_evaluation);
      add(draw->fragment, gpu::ShaderKind::fragment);
    }
  }
  return texts;
}

// Names of the pipelines that come with Firn and have the stage in them.
std::vector<std::string> users(const std::string& stage) {
  std::vector<std::string> names;
  for (const std::string& name : shipped_pipelines()) {
    config::Diagnostics ignored;  // its own `check` tells them
    graph::PipelineSpec pipeline = graph::load_pipeline(find_input(name, "pipelines"), {}, ignored);
    bool used = false;
    for (std::vector<graph::Item>* phase : {&pipeline.setup, &pipeline.step, &pipeline.frame})
      graph::each_use(*phase, [&](const graph::StageUse& use) { used |= use.stage == stage; });
    if (used) names.push_back(name);
  }
  return names;
}

int inspect(const InspectOptions& options) {
  const graph::Registry registry = stages::all_stages(nullptr);
  const OneStage stage = find_stage(options.stage, "inspect", registry);
  if (!options.set.empty() && !options.glsl) {
    config::Diagnostics diagnostics;
    diagnostics.error(stage.place, "--set chooses among the sources of the kernels: it goes with --glsl");
    throw config::InputError(diagnostics);
  }
  std::vector<KernelText> sources;
  if (options.glsl) sources = kernels(stage, registry, options.set);
  if (options.json) {
    nlohmann::json result = spec_json(*stage.spec, known_environment());
    result["used_by"] = users(stage.name);
    if (options.glsl) {
      result["glsl"] = nlohmann::json::array();
      for (const KernelText& source : sources)
        result["glsl"].push_back({{"work", source.work}, {"file", source.file}, {"source", source.text}});
    }
    fmt::print("{}\n", result.dump(2));
  } else if (options.glsl) {
    for (const KernelText& source : sources) fmt::print("// {}: {}\n{}\n", source.file, source.work, source.text);
  } else {
    print_spec(*stage.spec, known_environment());
    const std::vector<std::string> names = users(stage.name);
    fmt::print("\nUsed by: {}\n",
               names.empty() ? "none of the pipelines that come with Firn" : fmt::format("{}", fmt::join(names, ", ")));
  }
  return Status::done;
}

}  // namespace

void add_inspect(CLI::App& program, Action& action) {
  const auto options = std::make_shared<InspectOptions>();
  CLI::App* verb = program.add_subcommand("inspect", "One stage: equation, ports, parameters, work, who uses it");
  verb->add_option("STAGE", options->stage, "Stage, as list names them, or a file NAME.comp")->required();
  verb->add_flag("--glsl", options->glsl, "The whole source of its kernels, with every optional port bound");
  verb->add_option("--set", options->set, "K=V: parameters for --glsl")->allow_extra_args(false);
  verb->add_flag("--json", options->json, "As JSON");
  verb->callback([&action, options] { action = [options] { return inspect(*options); }; });
}

}  // namespace firn::app
