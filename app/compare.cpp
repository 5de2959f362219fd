// One scene under two pipelines, or under one with two settings.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <filesystem>

#include "app/choice.h"
#include "app/compare_report.h"
#include "app/verbs.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  Inputs inputs;  // of both; its pipeline is A's
  std::string other, output, device = "auto";
  std::vector<std::string> set_a, set_b;
  std::optional<std::uint64_t> steps, frames;
};

Inputs inputs_of(const CompareOptions& options, const std::string& pipeline, const std::vector<std::string>& own) {
  Inputs inputs = options.inputs;
  inputs.pipeline = pipeline;
  inputs.set.insert(inputs.set.end(), own.begin(), own.end());
  return inputs;
}

std::string stem(const std::string& file) { return fs::path(file).stem().string(); }

int compare(const CompareOptions& options) {
  const std::string other = options.other.empty() ? options.inputs.pipeline : options.other;
  if (options.other.empty() && options.set_a.empty() && options.set_b.empty()) {
    fmt::print(stderr, "compare: nothing differs; name a second pipeline, or give --set-a or --set-b\n");
    return Status::bad_input;
  }
  const Inputs of_a = inputs_of(options, options.inputs.pipeline, options.set_a);
  Inputs of_b = inputs_of(options, other, options.set_b);
  Loaded a = load(of_a, "");
  of_b.scene = a.scene_file;  // one scene for both
  Loaded b = load(of_b, "");
  print(a.diagnostics);
  print(b.diagnostics);
  if (std::error_code error; fs::equivalent(a.pipeline_file, b.pipeline_file, error) && options.set_a == options.set_b)
    spdlog::warn(
        "A and B are the same pipeline with the same settings: only their times can differ; --set-a or --set-b makes them differ");
  const std::string output =
      options.output.empty() ? fmt::format("out/compare-{}-{}", stem(options.inputs.pipeline), stem(other)) : options.output;
  const std::string scene = a.problem->scene.name.empty() ? a.scene_file : a.problem->scene.name;
  const std::unique_ptr<gpu::Device> device = gpu::Device::open(options.device);
  watch_signals();
  const bool quiet = spdlog::get_level() > spdlog::level::info;
  const Until until{options.steps, options.frames};
  const auto run = [&](const char* letter, const Inputs& inputs, const std::vector<std::string>& own, Loaded loaded) {
    spdlog::info("{}: {} on {}", letter, loaded.pipeline.name, scene);
    return run_side(letter, inputs, fmt::format("{}", fmt::join(own, " ")), std::move(loaded), *device, until, quiet);
  };
  Side one = run("A", of_a, options.set_a, std::move(a));
  if (one.interrupted) return Status::interrupted;
  Side two = run("B", of_b, options.set_b, std::move(b));
  if (two.interrupted) return Status::interrupted;
  const Comparison comparison = compare_sides(scene, device->info().name, std::move(one), std::move(two));
  write_report(comparison, output);
  fmt::print("{}", as_table(comparison));
  spdlog::info("page, pictures and numbers in {}", output);
  return Status::done;
}

}  // namespace

void add_compare(CLI::App& program, Action& action) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* verb = program.add_subcommand("compare", "One scene, two pipelines or settings: times, differences, pictures");
  add_inputs(*verb, options->inputs);
  verb->add_option("OTHER", options->other, "The pipeline to compare it with (default: the same)");
  verb->add_option("--set-a", options->set_a, "K=V as for --set, for the first alone")->allow_extra_args(false);
  verb->add_option("--set-b", options->set_b, "K=V as for --set, for the second alone")->allow_extra_args(false);
  verb->add_option("--steps", options->steps, "Stop after so many steps (default: at the scene's end)")->check(at_least(0));
  verb->add_option("--frames", options->frames, "Stop after so many frames")->check(at_least(0))->excludes("--steps");
  verb->add_option("--out", options->output, "Folder for the page (default: out/compare-PIPELINE-OTHER)");
  verb->add_option("--device", options->device, "As for run")->capture_default_str();
  verb->callback([&action, options] { action = [options] { return compare(*options); }; });
}

}  // namespace firn::app
