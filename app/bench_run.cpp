#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "app/bench.h"
#include "app/device_profile.h"
#include "app/program_cache.h"
#include "app/statistics.h"

namespace firn::app {
namespace {

struct Running {
  const BenchCase* what = nullptr;
  std::unique_ptr<BenchRun> run;
  int steps = 1;                // of one run
  std::vector<double> seconds;  // per step, one per run
  std::uint64_t turns = 0, counted = 0;
  std::map<std::string, std::vector<double>> stages;  // seconds per step, one per run
  std::vector<std::string> order;
};

std::string find_in_bench(const std::string& name, const std::string& folder) {
  const std::string found = find_input(name, "bench/" + folder);
  return found == name ? find_input(name, folder == "scenes" ? "pipelines/scenes" : folder) : found;
}

Inputs inputs_of(const std::string& pipeline, const std::string& scene, const std::vector<std::string>& set) {
  Inputs inputs;
  inputs.pipeline = find_in_bench(pipeline, "pipelines");
  inputs.scene = find_in_bench(scene, "scenes");
  inputs.set = set;
  return inputs;
}

void list_stages(Bench& bench, const std::string& name, const graph::Plan& plan, const std::vector<graph::Op>& ops) {
  for (const graph::Op& op : ops)
    if (const auto* run = std::get_if<graph::Run>(&op.what))
      static_cast<void>(bench.wants(name + "/" + plan.stages[static_cast<std::size_t>(run->stage)].spec.name));
    else if (const auto* repeat = std::get_if<graph::Repeat>(&op.what))
      list_stages(bench, name, plan, repeat->body);
}

// Of all repeats: in the height field, passes of relaxation.
std::uint64_t turns_of(const execution::Execution& execution) {
  std::uint64_t turns = 0;
  for (const execution::RepeatTurns& repeat : execution.turns()) turns += repeat.turns;
  return turns;
}

// Processors that were idle are slow at first: a step of 14 ms took 21 ms for up to a second.
void wake(std::vector<Running>& all) {
  const auto start = std::chrono::steady_clock::now();
  while (!all.empty() && std::chrono::steady_clock::now() - start < std::chrono::milliseconds(1500))
    for (Running& running : all) running.run->steps(1);
}

void time_stages(Running& running) {
  execution::Execution& execution = *running.run->execution;
  execution.time_passes(true);
  execution.take_times();
  running.run->steps(running.steps);
  std::map<std::string, double> sums;
  for (const execution::PassTime& pass : execution.take_times()) {
    const std::string& name = execution.plan().stages[static_cast<std::size_t>(pass.stage)].spec.name;
    sums[name] += pass.seconds / running.steps;
    if (std::ranges::find(running.order, name) == running.order.end()) running.order.push_back(name);
  }
  for (const auto& [name, seconds] : sums) running.stages[name].push_back(seconds);
  execution.time_passes(false);
}

void report(Bench& bench, const Running& running) {
  const BenchCase& what = *running.what;
  BenchResult result{what.name, running.seconds};
  if (what.per_particle) {
    result.count = static_cast<double>(running.run->loaded.problem->particles.position.size());
    result.unit = "particle-steps/s";
  }
  result.series = what.series;
  result.along = what.along;
  result.x = what.x;
  if (running.turns > 0)
    result.remark = fmt::format("{:.1f} passes of relaxation a step",
                                static_cast<double>(running.turns) / static_cast<double>(running.counted));
  bench.add(result);
  for (const std::string& stage : running.order) {
    BenchResult of_stage{what.name + "/" + stage, running.stages.at(stage)};
    bench.add(of_stage);
  }
}

}  // namespace

BenchRun::BenchRun(const std::string& pipeline, const std::string& scene, const std::vector<std::string>& set, gpu::Device& device_,
                   bool barriers_all, const std::function<void(Loaded&)>& change)
    : device(&device_) {
  const Inputs inputs = inputs_of(pipeline, scene, set);
  loaded = load(inputs, "");
  plan_for(loaded, inputs, profile_of(*device));
  if (change) change(loaded);
  execution = std::make_unique<execution::Execution>(
      *device, loaded.plan, loaded.registry, execution::Options{shader_folders(), barriers_all, false, program_cache_folder()});
  execution->setup();
}

double BenchRun::steps(int count) {
  const scene::Time& time = loaded.problem->scene.time;
  device->finish();
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) {
    execution->clock().dt = time.dt.value_or(1.0 / time.fps);
    execution->step();
  }
  device->finish();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / count;
}

std::optional<std::string> why_not(const std::function<void()>& start) {
  try {
    start();
    return std::nullopt;
  } catch (const config::InputError& error) {
    return error.what();
  } catch (const gpu::DeviceError& error) {
    return error.what();
  } catch (const execution::NumbersError& error) {
    return error.what();
  } catch (const std::bad_alloc&) {
    return "the machine's memory does not suffice";
  }
}

void run_in_turn(Bench& bench, const std::vector<BenchCase>& cases, const BenchPace& pace, bool stages) {
  std::vector<Running> all;
  for (const BenchCase& one : cases) {
    if (stages && bench.lists_below(one.name)) {
      const graph::Plan plan = load(inputs_of(one.pipeline, one.scene, one.set), "").plan;
      list_stages(bench, one.name, plan, plan.step);
    }
    if (!bench.wants(one.name)) continue;
    Running running;
    running.what = &one;
    const auto reason = why_not([&] {
      running.run = std::make_unique<BenchRun>(one.pipeline, one.scene, one.set, bench.device(), one.barriers_all);
      running.run->steps(pace.warm_up);
    });
    if (reason)
      bench.not_possible(one.name, *reason);
    else
      all.push_back(std::move(running));
  }
  wake(all);
  for (Running& running : all)
    running.steps = std::clamp(static_cast<int>(pace.seconds / running.run->steps(1)), pace.steps, std::max(pace.steps, 1000));
  for (int run = 0; run < bench.runs(); ++run)
    for (Running& running : all) {
      if (all.size() > 1) running.run->steps(1);  // the others have taken the caches
      const std::uint64_t turns = turns_of(*running.run->execution);
      running.seconds.push_back(running.run->steps(running.steps));
      running.turns += turns_of(*running.run->execution) - turns;
      running.counted += static_cast<std::uint64_t>(running.steps);
    }
  if (stages)
    for (int run = 0; run < std::min(3, bench.runs()); ++run)
      for (Running& running : all) time_stages(running);
  for (const Running& running : all)
    if (const auto reason = why_not([&] { running.run->execution->check_faults(); }))
      bench.not_possible(running.what->name, *reason);
    else
      report(bench, running);
}

}  // namespace firn::app
