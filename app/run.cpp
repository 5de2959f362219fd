#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <ctime>
#include <filesystem>

#include "app/arrays.h"
#include "app/choice.h"
#include "app/command_line.h"
#include "app/dump.h"
#include "app/export.h"
#include "app/load.h"
#include "app/manifest.h"
#include "app/progress.h"
#include "app/simulation.h"
#include "app/verbs.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  Inputs inputs;
  std::string output, device = "auto", barriers = "derived";
  std::optional<std::uint64_t> steps, frames;
  std::vector<std::string> dumps;
};

// out/<pipeline>-<scene>, so that runs of several pipelines on several scenes do not mix.
std::string default_output(const RunOptions& options) {
  std::string name = fs::path(options.inputs.pipeline).stem().string();
  if (!options.inputs.scene.empty()) name += "-" + fs::path(options.inputs.scene).stem().string();
  return (fs::path("out") / name).string();
}

void warn_of_long_steps(const scene::Scene& scene) {
  if (!scene.time.dt || scene.snow.empty()) return;
  // cfl 1 is where the explicit scheme breaks; the scene's own cfl is its safety.
  const double limit = stages::stable_time_step(scene) / scene.time.cfl;
  if (limit > 0 && *scene.time.dt > limit)
    spdlog::warn("dt {:g} s is beyond what the explicit scheme bears with this material and grid, about {:.2g} s", *scene.time.dt,
                 limit);
}

// Pictures of an earlier, longer run must not be taken for this one's. Only what Firn itself wrote is removed: files by its own
// names, in a folder with its manifest.
void remove_earlier_run(const fs::path& output) {
  if (!fs::exists(output / "manifest.json")) return;
  fs::remove(output / "manifest.json");
  fs::remove(output / "video.mp4");
  if (!fs::is_directory(output / "frames")) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(output / "frames")) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && name.ends_with(".png")) fs::remove(entry.path());
  }
}

void prepare_output(const std::string& output) {
  try {
    fs::create_directories(output);
    remove_earlier_run(output);
  } catch (const fs::filesystem_error& error) {
    throw std::runtime_error(fmt::format("cannot make the folder {}: {}", output, error.code().message()));
  }
}

int run(const RunOptions& options) {
  RunFacts facts;
  facts.command = command_line();
  facts.started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  const std::string output = options.output.empty() ? default_output(options) : options.output;
  config::Diagnostics of_dumps;
  const std::vector<NamedFile> dumps = read_named_files(options.dumps, "--dump", "BUFFER", of_dumps);
  Inputs inputs = options.inputs;
  for (const NamedFile& dump : dumps) inputs.keep.push_back(dump.name);
  Loaded loaded = load(inputs, output);
  print(loaded.diagnostics);
  check_dumps(dumps, loaded.plan, of_dumps);
  config::throw_if_errors(of_dumps);
  const scene::Scene& scene = loaded.problem->scene;
  const std::unique_ptr<gpu::Device> device = gpu::Device::open(options.device);
  plan_for(loaded, inputs, device->info().software);
  spdlog::info("{} on {}", loaded.pipeline.name, scene.name.empty() ? loaded.scene_file : scene.name);
  spdlog::info("{} particles, {} stages, {:.1f} MiB; {}", loaded.problem->particles.position.size(), loaded.plan.stages.size(),
               static_cast<double>(loaded.plan.bytes) / (1 << 20), device->info().name);
  warn_of_long_steps(scene);

  prepare_output(output);
  execution::Execution execution(*device, loaded.plan, loaded.registry, {shader_folders(), options.barriers == "all", false});
  watch_signals();

  const auto start = std::chrono::steady_clock::now();
  const auto total = options.steps    ? static_cast<double>(*options.steps)
                     : options.frames ? static_cast<double>(*options.frames)
                                      : scene.time.end;
  Progress progress(total, spdlog::get_level() > spdlog::level::info);
  const auto conclude = [&](int status, const std::string& message) {
    progress.finish();
    facts.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    facts.steps = execution.clock().step;
    facts.frames = execution.clock().frame;
    facts.time = execution.clock().time;
    facts.exit_status = status;
    facts.message = message;
    write_manifest((fs::path(output) / "manifest.json").string(), manifest(loaded, device->info(), facts));
  };
  Ending ending = Ending::complete;
  try {
    ending =
        simulate(execution, scene.time, {options.steps, options.frames}, device->info().software, [&](const graph::Clock& clock) {
          progress.update(options.steps    ? static_cast<double>(clock.step)
                          : options.frames ? static_cast<double>(clock.frame)
                                           : clock.time,
                          clock.frame, clock.step);
        });
    execution.finish();
    for (const NamedFile& dump : dumps) write_array(execution, dump.name, dump.file);
  } catch (const execution::NumbersError& error) {
    conclude(Status::numbers_broke, error.what());
    throw;
  } catch (const gpu::DeviceError& error) {
    conclude(Status::device_lacks, error.what());
    throw;
  } catch (const std::exception& error) {
    conclude(Status::failed, error.what());
    throw;
  }
  const int status = ending == Ending::interrupted ? Status::interrupted : Status::done;
  conclude(status, ending == Ending::interrupted ? "interrupted" : "");
  spdlog::info("{} steps, {} frames, {:.3f} s simulated in {:.1f} s ({:.0f} steps/s); results in {}", facts.steps, facts.frames,
               facts.time, facts.seconds, static_cast<double>(facts.steps) / std::max(facts.seconds, 1e-9), output);
  return status;
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* verb = program.add_subcommand("run", "Simulate: pictures, video, data, and a manifest of the run");
  add_inputs(*verb, options->inputs);
  verb->add_option("--steps", options->steps, "Stop after so many steps")->check(at_least(0));
  verb->add_option("--frames", options->frames, "Stop after so many frames")->check(at_least(0))->excludes("--steps");
  verb->add_option("--out", options->output, "Folder for results (default: out/<pipeline>, with --scene out/<pipeline>-<scene>)");
  add_export(*verb, options->inputs);
  verb->add_option("--dump", options->dumps, "BUFFER=FILE.npy: write a buffer at the end")->allow_extra_args(false);
  verb->add_option("--device", options->device,
                   "auto (hardware first), hardware, software, a number as doctor lists them, or part of a name")
      ->capture_default_str();
  verb->add_option("--barriers", options->barriers, "derived: those of the plan; all: a full one after every piece of work")
      ->check(one_of({"derived", "all"}))
      ->capture_default_str();
  verb->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace firn::app
