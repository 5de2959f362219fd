// One stage alone on arrays.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/arrays.h"
#include "app/load.h"
#include "app/program_cache.h"
#include "app/try_outputs.h"
#include "app/try_stage.h"
#include "app/verbs.h"

namespace firn::app {
namespace {

int try_stage(const TryOptions& options) {
  const Trial trial = prepare_trial(options);
  print(trial.diagnostics);
  for (const std::string& note : trial.notes) spdlog::info("{}", note);
  const std::unique_ptr<gpu::Device> device = gpu::Device::open(options.device);
  execution::Execution execution(*device, trial.plan, trial.registry, {shader_folders(), false, false, program_cache_folder()});
  for (const auto& [buffer, values] : trial.contents) fill_buffer(execution, buffer, values);
  execution.clock().time = options.time;
  for (std::int64_t i = 0; i < options.repeat; ++i) {
    execution.clock().dt = trial.dt;
    execution.step();
  }
  // Written before faults are told: they are what one looks at to find a fault.
  for (const NamedFile& output : trial.outputs) write_array(execution, output.name, output.file);
  print_outputs(execution, options.json);
  execution.check_faults();
  return Status::done;
}

}  // namespace

void add_try(CLI::App& program, Action& action) {
  const auto options = std::make_shared<TryOptions>();
  CLI::App* verb = program.add_subcommand("try", "One stage alone on NumPy arrays");
  verb->add_option("STAGE", options->stage, "Stage, as list names them, or a file NAME.comp")->required();
  verb->add_option("--in", options->in, "PORT=FILE.npy: what the port holds; domains take their size from these arrays")
      ->allow_extra_args(false);
  verb->add_option("--out", options->out, "PORT=FILE.npy: where to write what the stage leaves there")->allow_extra_args(false);
  verb->add_option("--set", options->set, "K=V: a parameter of the stage, or part of the scene (scene.gravity=[0,-1.62,0])")
      ->allow_extra_args(false);
  verb->add_option("--scene", options->scene, "Scene file: constants, and sizes that no array tells");
  verb->add_option("--constant", options->constants, "NAME=VALUE: a constant that a scene would tell, such as field_cell=0.1")
      ->allow_extra_args(false);
  verb->add_option("--size", options->sizes, "DOMAIN=N or DOMAIN=[rows, columns]: a size that no array tells")
      ->allow_extra_args(false);
  verb->add_option("--dt", options->dt, "Length of the step, s (default: the scene's)");
  verb->add_option("--time", options->time, "Time at the start of the step, s")->capture_default_str();
  verb->add_option("--repeat", options->repeat, "Run the stage so many times, each on what the last has left")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  verb->add_option("--device", options->device, "As for run")->capture_default_str();
  verb->add_flag("--json", options->json, "The table of outputs as JSON");
  verb->callback([&action, options] { action = [options] { return try_stage(*options); }; });
}

}  // namespace firn::app
