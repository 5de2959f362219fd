// Where the time of a step goes: every piece of work by itself, from timestamps on the device.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/choice.h"
#include "app/load.h"
#include "app/simulation.h"
#include "app/statistics.h"
#include "app/verbs.h"

namespace firn::app {
namespace {

struct ProfileOptions {
  Inputs inputs;
  std::string device = "auto", format = "table";
  std::uint64_t steps = 200, warm_up = 50;
};

struct Pass {
  std::string stage, work;
  std::vector<double> seconds;  // one per launch
  std::uint64_t bytes = 0;      // read and written by one launch, if every element of its buffers is
};

std::string work_name(const graph::Work& work) {
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) return dispatch->kernel;
  if (const auto* draw = std::get_if<graph::Draw>(&work)) return draw->name;
  return "host";
}

std::uint64_t bytes_of(const graph::Plan& plan, const std::vector<graph::Op>& ops, int stage, int work) {
  for (const graph::Op& op : ops) {
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what))
      if (const std::uint64_t found = bytes_of(plan, repeat->body, stage, work)) return found;
    const auto* run = std::get_if<graph::Run>(&op.what);
    if (run == nullptr || run->stage != stage || run->work != work) continue;
    std::uint64_t bytes = 0;
    for (const graph::BufferAccess& access : run->accesses)
      bytes += plan.buffers[static_cast<std::size_t>(access.buffer)].bytes *
               (graph::reads(access.access) && graph::writes(access.access) ? 2 : 1);
    return bytes;
  }
  return 0;
}

void print_table(const std::vector<Pass>& passes, double total, std::uint64_t steps) {
  fmt::print("{:<30} {:<38} {:>9} {:>10} {:>10} {:>7} {:>9}\n", "stage", "work", "per step", "median us", "p90 us", "share",
             "GB/s");
  for (const Pass& pass : passes) {
    const double all = std::accumulate(pass.seconds.begin(), pass.seconds.end(), 0.0);
    fmt::print("{:<30} {:<38} {:>9.2f} {:>10.1f} {:>10.1f} {:>6.1f}% {:>9.2f}\n", pass.stage, pass.work,
               static_cast<double>(pass.seconds.size()) / static_cast<double>(steps), 1e6 * median(pass.seconds),
               1e6 * quantile(pass.seconds, 0.9), 100 * all / total, static_cast<double>(pass.bytes) / median(pass.seconds) * 1e-9);
  }
}

nlohmann::json as_json(const std::vector<Pass>& passes, double total, std::uint64_t steps) {
  nlohmann::json list = nlohmann::json::array();
  for (const Pass& pass : passes)
    list.push_back({{"stage", pass.stage},
                    {"work", pass.work},
                    {"launches", pass.seconds.size()},
                    {"median", median(pass.seconds)},
                    {"p90", quantile(pass.seconds, 0.9)},
                    {"share", std::accumulate(pass.seconds.begin(), pass.seconds.end(), 0.0) / total},
                    {"bytes", pass.bytes}});
  return {{"steps", steps}, {"passes", list}};
}

int profile(const ProfileOptions& options) {
  const Loaded loaded = load(options.inputs, "");
  print(loaded.diagnostics);
  const std::unique_ptr<gpu::Device> device = gpu::Device::open(options.device);
  execution::Execution execution(*device, loaded.plan, loaded.registry, {shader_folders(), false, true});
  const scene::Time& time = loaded.problem->scene.time;
  execution.setup();
  const auto step = [&] {
    execution.clock().dt = time.dt.value_or(1.0 / time.fps);
    execution.step();
  };
  for (std::uint64_t i = 0; i < options.warm_up; ++i) step();
  execution.take_times();
  std::map<std::pair<int, int>, std::vector<double>> times;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < options.steps; ++i) {
    step();
    for (const execution::PassTime& pass : execution.take_times()) times[{pass.stage, pass.work}].push_back(pass.seconds);
  }
  execution.check_faults();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::vector<Pass> passes;
  double total = 0;
  for (const auto& [key, seconds] : times) {
    const graph::PlannedStage& stage = loaded.plan.stages[static_cast<std::size_t>(key.first)];
    passes.push_back({stage.label, work_name(stage.spec.work[static_cast<std::size_t>(key.second)]), seconds,
                      bytes_of(loaded.plan, loaded.plan.step, key.first, key.second)});
    total += std::accumulate(seconds.begin(), seconds.end(), 0.0);
  }
  if (options.format == "json") {
    nlohmann::json result = as_json(passes, total, options.steps);
    result["pipeline"] = loaded.pipeline.name;
    result["device"] = device->info().name;
    fmt::print("{}\n", result.dump(2));
  } else {
    print_table(passes, total, options.steps);
    fmt::print(
        "{} steps: {:.3f} ms a step in passes, {:.3f} ms by the clock on the wall; GB/s as if every element were touched once\n",
        options.steps, 1e3 * total / static_cast<double>(options.steps), 1e3 * wall / static_cast<double>(options.steps));
  }
  if (device->info().software)
    spdlog::info(
        "this software renderer's timestamps say nothing of draws: times are by the processor's clock, each pass waited for");
  return Status::done;
}

}  // namespace

void add_profile(CLI::App& program, Action& action) {
  const auto options = std::make_shared<ProfileOptions>();
  CLI::App* verb = program.add_subcommand("profile", "Time every pass of a step");
  add_inputs(*verb, options->inputs);
  verb->add_option("--steps", options->steps, "Steps to time")->check(at_least(1))->capture_default_str();
  verb->add_option("--warm-up", options->warm_up, "Steps before them")->check(at_least(0))->capture_default_str();
  verb->add_option("--format", options->format, "table or json")->check(one_of({"table", "json"}))->capture_default_str();
  verb->add_option("--device", options->device, "As for run")->capture_default_str();
  verb->callback([&action, options] { action = [options] { return profile(*options); }; });
}

}  // namespace firn::app
