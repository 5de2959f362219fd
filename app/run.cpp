#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>

#include "app/arrays.h"
#include "app/checkpoint.h"
#include "app/choice.h"
#include "app/command_line.h"
#include "app/device_profile.h"
#include "app/dump.h"
#include "app/export.h"
#include "app/files.h"
#include "app/identity.h"
#include "app/load.h"
#include "app/manifest.h"
#include "app/metrics.h"
#include "app/program_cache.h"
#include "app/progress.h"
#include "app/repeat.h"
#include "app/run_log.h"
#include "app/run_start.h"
#include "app/simulation.h"
#include "app/verbs.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void warn_of_long_steps(const scene::Scene& scene) {
  if (!scene.time.dt || !scene.has_particles()) return;
  // cfl 1 is where the explicit scheme breaks; the scene's own cfl is its safety.
  const double limit = stages::stable_time_step(scene) / scene.time.cfl;
  if (limit > 0 && *scene.time.dt > limit)
    spdlog::warn("dt {:g} s is beyond what the explicit scheme bears with this material and grid, about {:.2g} s", *scene.time.dt,
                 limit);
}

// A run goes on from a checkpoint bit for bit, or not at all.
void check_same(const Checkpoint& checkpoint, const json& identity, const std::string& device) {
  const json& about = checkpoint.manifest;
  if (const std::vector<std::string> changed = differences(about["identity"], identity); !changed.empty()) {
    constexpr std::size_t most = 8;
    const std::vector<std::string> shown_ones(changed.begin(), changed.begin() + static_cast<long>(std::min(most, changed.size())));
    config::Diagnostics diagnostics;
    diagnostics.error(
        {shown(checkpoint.folder), 0, 0},
        fmt::format("cannot go on from here, as the run is not the same any more: {}{}; run it anew, or undo that",
                    fmt::join(shown_ones, "; "), changed.size() > most ? fmt::format("; and {} more", changed.size() - most) : ""));
    throw config::InputError(diagnostics);
  }
  const json program = program_json();
  if (about.value("firn", json()) != program["firn"] || about.value("revision", json()) != program["revision"])
    spdlog::warn("the checkpoint is of another build of Firn: what follows may differ in the last digits");
  if (about.value("device", json()) != device)
    spdlog::warn("the checkpoint was written on another device: what follows may differ in the last digits");
}

// One run, from the first step of this process to the last, with all that it leaves.
class Session {
 public:
  Session(const RunStart& start, const Loaded& loaded, const std::vector<NamedFile>& dumps, const gpu::DeviceInfo& device,
          const json& identity, const fs::path& output, RunLog& log, execution::Execution& execution)
      : start_(start),
        loaded_(loaded),
        dumps_(dumps),
        device_(device),
        identity_(identity),
        output_(output),
        log_(log),
        execution_(execution),
        first_(execution.clock()),
        metrics_(output, loaded, first_) {
    facts_.command = command_line();
    facts_.started = now_in_utc();
    if (start.checkpoint) {
      for (const json& before : start.checkpoint->manifest.value("resumed_from", json::array()))
        if (before.is_string()) facts_.resumed_from.push_back(before);
      facts_.resumed_from.push_back(start.checkpoint->folder.filename().string());
    }
    write();
    log_.event("start", {{"command", facts_.command}, {"step", first_.step}, {"device", device.name}});
  }

  Status run(const std::vector<std::string>& left_out) {
    try {
      const Ending ending = steps();
      if (ending == Ending::interrupted) checkpoint_when_interrupted();
      execution_.finish();
      for (const NamedFile& dump : dumps_) {
        if (execution_.clock().step == first_.step && std::ranges::find(left_out, dump.name) != left_out.end())
          throw std::runtime_error(fmt::format("no step was left to make '{}' in, which the checkpoint has not got", dump.name));
        write_array(execution_, dump.name, dump.file);
      }
      const Status status = ending == Ending::interrupted ? Status::interrupted : Status::done;
      facts_.outputs = hashes_of_outputs(output_, dumps_);
      conclude(status, ending == Ending::interrupted ? "interrupted" : "");
      spdlog::info("{} steps, {} frames, {:.3f} s simulated in {:.1f} s ({:.0f} steps/s); results in {}", facts_.steps,
                   facts_.frames, facts_.time, facts_.seconds,
                   static_cast<double>(facts_.steps - first_.step) / std::max(facts_.seconds, 1e-9), output_.string());
      if (ending == Ending::interrupted && !last_checkpoint_.empty())
        spdlog::info("the state is in {}; to go on: firn run --resume {}", last_checkpoint_.string(), output_.string());
      return status;
    } catch (const execution::NumbersError& error) {
      conclude_failed(Status::numbers_broke, error.what());
      throw;
    } catch (const gpu::DeviceError& error) {
      conclude_failed(Status::device_lacks, error.what());
      throw;
    } catch (const std::exception& error) {
      conclude_failed(Status::failed, error.what());
      throw;
    }
  }

  [[nodiscard]] const json& outputs() const { return facts_.outputs; }

 private:
  Ending steps() {
    const RunOptions& options = start_.options;
    const scene::Time& time = loaded_.problem->scene.time;
    const auto done = [&](const graph::Clock& clock) {
      return options.steps ? static_cast<double>(clock.step) : options.frames ? static_cast<double>(clock.frame) : clock.time;
    };
    const double total = options.steps    ? static_cast<double>(*options.steps)
                         : options.frames ? static_cast<double>(*options.frames)
                                          : time.end;
    Progress progress(total, spdlog::get_level() > spdlog::level::info, done(first_), first_.step);
    std::uint64_t frames = first_.frame;
    const auto after_step = [&](const graph::Clock& clock) {
      if (clock.frame > frames) {
        frames = clock.frame;
        metrics_.add(execution_);
        log_.event("frame", {{"frame", clock.frame - 1}, {"step", clock.step}, {"simulated_seconds", clock.time}});
      }
      if (options.checkpoint_every > 0 && clock.step > first_.step && clock.step % options.checkpoint_every == 0) checkpoint();
      progress.update(done(clock), clock.frame, clock.step);
    };
    return simulate(execution_, time, {options.steps, options.frames}, device_.software, after_step,
                    start_.checkpoint ? Start::resumed : Start::fresh);
  }

  void checkpoint() {
    const std::size_t keep = start_.options.keep_checkpoints.value_or(default_keep);
    if (keep == 0) return;
    const auto begin = std::chrono::steady_clock::now();
    json about = program_json();
    about.update({{"identity", identity_},
                  {"inputs", to_json(start_.options)},
                  {"device", device_.name},
                  {"resumed_from", facts_.resumed_from}});
    last_checkpoint_ = write_checkpoint(output_, execution_, about, keep);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    log_.event("checkpoint",
               {{"step", execution_.clock().step}, {"folder", last_checkpoint_.filename().string()}, {"seconds", seconds}});
    spdlog::debug("checkpoint {} in {:.2f} s", last_checkpoint_.string(), seconds);
  }

  // One that was written or read after this very step will do.
  void checkpoint_when_interrupted() {
    const fs::path there = output_ / "checkpoints" / checkpoint_name(execution_.clock().step);
    if (fs::exists(there))
      last_checkpoint_ = there;
    else
      checkpoint();
  }

  void write() const { write_manifest(output_ / run_manifest, manifest(loaded_, identity_, device_, start_.options, facts_)); }

  void conclude(int status, const std::string& message) {
    facts_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    facts_.steps = execution_.clock().step;
    facts_.frames = execution_.clock().frame;
    facts_.time = execution_.clock().time;
    facts_.exit_status = status;
    facts_.message = message;
    write();
    log_.event("end", {{"exit_status", status},
                       {"message", message},
                       {"step", facts_.steps},
                       {"seconds", facts_.seconds},
                       {"seconds_for_metrics", metrics_.seconds()}});
  }

  // A disk that is full takes no manifest either; what went wrong first is told all the same.
  void conclude_failed(int status, const std::string& message) {
    try {
      conclude(status, message);
    } catch (const std::runtime_error& error) {
      spdlog::error("{}", error.what());
    }
  }

  const RunStart& start_;
  const Loaded& loaded_;
  const std::vector<NamedFile>& dumps_;
  const gpu::DeviceInfo& device_;
  const json& identity_;
  const fs::path output_;
  RunLog& log_;
  execution::Execution& execution_;
  const graph::Clock first_;
  Metrics metrics_;
  RunFacts facts_;
  fs::path last_checkpoint_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

int run(const RunOptions& given) {
  const RunStart start = run_start(given);
  const RunOptions& options = start.options;
  config::Diagnostics of_dumps;
  const std::vector<NamedFile> dumps = read_named_files(options.dumps, "--dump", "BUFFER", of_dumps);
  Inputs inputs = options.inputs;
  for (const NamedFile& dump : dumps) inputs.keep.push_back(dump.name);
  Loaded loaded = load(inputs, start.output.string());
  print(loaded.diagnostics);
  check_dumps(dumps, loaded.plan, start.output, of_dumps);
  config::throw_if_errors(of_dumps);
  const scene::Scene& scene = loaded.problem->scene;
  const std::unique_ptr<gpu::Device> device = gpu::Device::open(options.device);
  plan_for(loaded, inputs, profile_of(*device));
  const json identity = identity_of(loaded);
  if (start.checkpoint) check_same(*start.checkpoint, identity, device->info().name);
  spdlog::info("{} on {}", loaded.pipeline.name, scene.name.empty() ? loaded.scene_file : scene.name);
  const std::string room = scene.max_particles > 0 ? fmt::format(" (room for {})", scene.max_particles) : "";
  spdlog::info("{} particles{}, {} stages, {:.1f} MiB; {}", loaded.problem->particles.position.size(), room,
               loaded.plan.stages.size(), static_cast<double>(loaded.plan.bytes) / (1 << 20), device->info().name);
  warn_of_long_steps(scene);

  std::optional<RunFolder> folder;  // locked until the film, too, is closed
  execution::Execution execution(*device, loaded.plan, loaded.registry,
                                 {shader_folders(), options.barriers == "all", false, program_cache_folder()});
  folder.emplace(start.output, start.claim);
  if (!folder->moved().empty())
    spdlog::info("the earlier run in {} is now in {}; --force would have replaced it", folder->path().string(),
                 folder->moved().string());
  std::vector<std::string> left_out;
  if (start.checkpoint) {
    left_out = restore(*start.checkpoint, execution);
    if (start.claim == Claim::resume) go_back_to(*start.checkpoint, options.keep_checkpoints.value_or(default_keep));
    remove_frames_from(folder->path(), start.checkpoint->clock.frame);
    spdlog::info("going on from {}: step {}, frame {}, {:.4f} s", start.checkpoint->folder.string(), start.checkpoint->clock.step,
                 start.checkpoint->clock.frame, start.checkpoint->clock.time);
  }
  watch_signals();
  RunLog log(folder->path());
  for (const config::Diagnostic& warning : loaded.diagnostics.all())  // told before there was a log
    log.event("message", {{"level", "warning"}, {"text", config::to_string(warning)}});
  Session session(start, loaded, dumps, device->info(), identity, folder->path(), log, execution);
  const Status status = session.run(left_out);
  if (status != Status::done || start.repeated.is_null()) return status;
  return tell_of_repeat(start.repeated, identity, device->info().name, session.outputs()) ? Status::done : Status::failed;
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* verb = program.add_subcommand("run", "Simulate: pictures, video, data, checkpoints, and a manifest of the run");
  add_inputs(*verb, options->inputs);
  CLI::Option* pipeline = verb->get_option("PIPELINE")->required(false);
  verb->add_option("--steps", options->steps, "Stop after so many steps")->check(at_least(0));
  verb->add_option("--frames", options->frames, "Stop after so many frames")->check(at_least(0))->excludes("--steps");
  add_export(*verb, options->inputs);
  verb->add_option(
      "--out", options->output,
      "Folder for results (default: out/<pipeline>, with --scene out/<pipeline>-<scene>); an earlier run in it moves to a "
      "folder with a number");
  verb->add_flag("--force", options->force, "Replace an earlier run in that folder");
  verb->add_option("--dump", options->dumps, "BUFFER=FILE.npy: write a buffer at the end")->allow_extra_args(false);
  verb->add_option("--checkpoint-every", options->checkpoint_every,
                   "Write a checkpoint every so many steps; without it only when the run is interrupted")
      ->check(at_least(1));
  verb->add_option("--keep-checkpoints", options->keep_checkpoints, "Keep the newest so many (default: 3); 0: write none")
      ->check(at_least(0));
  CLI::Option* resume =
      verb->add_option("--resume",
                       "Go on from the newest checkpoint in the folder for results, or from this one, or from the newest "
                       "of this run; then PIPELINE may be left out")
          ->type_name("[FOLDER]")
          ->expected(0, 1);
  CLI::Option* from =
      verb->add_option("--from", options->from, "Repeat the run of this manifest, and say whether its outputs are the same");
  from->excludes(resume)->excludes(pipeline);
  verb->add_option("--device", options->device,
                   "auto (hardware first, then software), hardware, software, a number as doctor lists them, or part of a name")
      ->capture_default_str();
  verb->add_option("--barriers", options->barriers, "derived: those of the plan; all: a full one after every piece of work")
      ->check(one_of({"derived", "all"}))
      ->capture_default_str();
  verb->callback([&action, options, resume] {
    if (resume->count() > 0) options->resume = resume->results().empty() ? std::string() : resume->results().front();
    if (options->inputs.pipeline.empty() && options->from.empty() && options->resume.value_or("").empty())
      throw CLI::RequiredError("PIPELINE");
    action = [options] { return run(*options); };
  });
}

}  // namespace firn::app
