// The standard measurements. What is compared is run in turn within one call, and medians are told: machines are noisy.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/choice.h"
#include "app/load.h"
#include "app/statistics.h"
#include "app/verbs.h"
#include "config/nearest.h"
#include "graph/execution/execution.h"

namespace firn::app {
namespace {

// One thing to measure: steps of a pipeline on a scene.
struct Case {
  std::string name;  // "step/mpm_snow/50000"
  std::string pipeline, scene;
  std::vector<std::string> set;
  bool barriers_all = false;
  bool per_particle = false;  // the rate counts particles times steps, else steps
};

// Cases of one turn are run one after another, again and again.
struct Bench {
  std::string name, doc;
  std::vector<std::vector<Case>> turns;
  int warm_up = 20, steps = 20;  // of one run
};

Case field_case(const std::string& method, int cells, const std::string& bodies) {
  return {fmt::format("heightfield/{}/{}/{}", method, cells, bodies),
          "heightfield_" + method,
          bodies == "1" ? "field" : "stones",
          {fmt::format("scene.field.cells=[{0}, {0}]", cells)}};
}

Case ball_case(const std::string& pipeline, const std::string& particles, double radius) {
  return {fmt::format("step/{}/{}", pipeline, particles),         pipeline, "ball",
          {fmt::format("scene.snow.0.sphere.radius={}", radius)}, false,    true};
}

Case with_all_barriers(Case one) {
  one.name += "/all";
  one.barriers_all = true;
  return one;
}
Case with_derived_barriers(Case one) {
  one.name += "/derived";
  return one;
}
Case renamed(Case one, const std::string& name) {
  one.name = name;
  return one;
}

std::vector<Bench> benches(bool small) {
  Bench field{"heightfield", "a step of the height field, drawing not counted: by method, cells per side, bodies", {}, 60, 60};
  for (const int cells : small ? std::vector{256, 512} : std::vector{256, 512, 1024, 2048, 4096})
    for (const char* bodies : {"1", "500"})
      field.turns.push_back({field_case("contour", cells, bodies), field_case("distance", cells, bodies)});
  Bench step{"step", "a step of material-point snow, falling ball", {}, 3, small ? 4 : 20};
  step.turns.push_back({ball_case("mpm_thesis", "50000", 0.571), ball_case("mpm_snow", "50000", 0.571)});
  if (!small) step.turns.push_back({ball_case("mpm_snow", "500000", 1.2302)});
  Bench barriers{"barriers", "the plan's own barriers against a full one after every piece of work", {}, 5, 10};
  for (const Case& one : {renamed(field_case("contour", 256, "1"), "barriers/heightfield_contour"),
                          renamed(ball_case("mpm_snow", "50000", 0.571), "barriers/mpm_snow")})
    barriers.turns.push_back({with_derived_barriers(one), with_all_barriers(one)});
  return {field, step, barriers};
}

struct Running {
  Case what;
  Loaded loaded;
  std::unique_ptr<execution::Execution> execution;
  std::vector<double> seconds;  // per step, one per run
  std::uint64_t steps = 0, turns = 0;

  void advance(gpu::Device& device, int count) {
    for (int i = 0; i < count; ++i) {
      const scene::Time& time = loaded.problem->scene.time;
      execution->clock().dt = time.dt.value_or(1.0 / time.fps);
      execution->step();
    }
    device.finish();
  }
};

std::vector<Running> start(const std::vector<Case>& cases, gpu::Device& device, int warm_up) {
  std::vector<Running> all;
  for (const Case& one : cases) {
    Inputs inputs;
    inputs.pipeline = find_input(one.pipeline, "pipelines");
    inputs.scene = find_input(one.scene, "bench/scenes");
    if (inputs.scene == one.scene) inputs.scene = find_input(one.scene, "pipelines/scenes");
    inputs.set = one.set;
    Running& running = all.emplace_back();
    running.what = one;
    running.loaded = load(inputs, "");
    running.execution = std::make_unique<execution::Execution>(device, running.loaded.plan, running.loaded.registry,
                                                               execution::Options{shader_folders(), one.barriers_all, false});
    running.execution->setup();
    running.advance(device, warm_up);
  }
  return all;
}

// Of all repeats: in the height field, passes of relaxation.
std::uint64_t turns_of(const execution::Execution& execution) {
  std::uint64_t turns = 0;
  for (const execution::RepeatTurns& repeat : execution.turns()) turns += repeat.turns;
  return turns;
}

nlohmann::json result_of(const Running& running) {
  const double seconds = median(running.seconds);
  const double count = running.what.per_particle ? static_cast<double>(running.loaded.problem->particles.position.size()) : 1;
  nlohmann::json result = {{"name", running.what.name},
                           {"seconds", seconds},
                           {"runs", running.seconds.size()},
                           {"rate", count / seconds},
                           {"unit", running.what.per_particle ? "particle-steps/s" : "steps/s"}};
  if (running.turns > 0)
    result["relaxation_passes"] = static_cast<double>(running.turns) / static_cast<double>(running.steps);  // per step
  return result;
}

void print_result(const nlohmann::json& result) {
  const std::string passes = result.contains("relaxation_passes")
                                 ? fmt::format("  {:.1f} passes of relaxation a step", result["relaxation_passes"].get<double>())
                                 : "";
  fmt::print("{:<40} {:>10.3f} ms  {:>12.4g} {}{}\n", result["name"].get<std::string>(), 1e3 * result["seconds"].get<double>(),
             result["rate"].get<double>(), result["unit"].get<std::string>(), passes);
  std::fflush(stdout);
}

struct BenchOptions {
  std::string name, sizes = "full", device = "auto";
  int runs = 7;
  bool json = false;
};

int bench(const BenchOptions& options) {
  const std::vector<Bench> all = benches(options.sizes == "small");
  std::vector<std::string> names;
  for (const Bench& one : all) names.push_back(one.name);
  if (!options.name.empty() && std::ranges::find(names, options.name) == names.end()) {
    fmt::print(stderr, "no benchmark '{}'{}\n", options.name, config::suggestion(options.name, names));
    return Status::bad_input;
  }
  const std::unique_ptr<gpu::Device> device = gpu::Device::open(options.device);
  nlohmann::json results = nlohmann::json::array();
  if (!options.json) fmt::print("{}\n", device->info().name);
  for (const Bench& one : all) {
    if (!options.name.empty() && one.name != options.name) continue;
    if (!options.json)
      fmt::print("\n{}: {}; medians of {} runs of {} steps, in turn\n", one.name, one.doc, options.runs, one.steps);
    for (const std::vector<Case>& cases : one.turns) {
      std::vector<Running> running = start(cases, *device, one.warm_up);
      for (int run = 0; run < options.runs; ++run)
        for (Running& r : running) {
          const std::uint64_t turns = turns_of(*r.execution);
          const auto begin = std::chrono::steady_clock::now();
          r.advance(*device, one.steps);
          r.seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / one.steps);
          r.turns += turns_of(*r.execution) - turns;
          r.steps += static_cast<std::uint64_t>(one.steps);
        }
      for (Running& r : running) {
        r.execution->check_faults();
        results.push_back(result_of(r));
        if (!options.json) print_result(results.back());
      }
    }
  }
  if (options.json) fmt::print("{}\n", nlohmann::json{{"device", device->info().name}, {"results", results}}.dump(2));
  return Status::done;
}

}  // namespace

void add_bench(CLI::App& program, Action& action) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = program.add_subcommand("bench", "The standard measurements: heightfield, step, barriers");
  verb->add_option("NAME", options->name, "One of them (default: all)");
  verb->add_option("--sizes", options->sizes, "small: for machines without a GPU; full")
      ->check(one_of({"small", "full"}))
      ->capture_default_str();
  verb->add_option("--runs", options->runs, "Runs whose median is told")->check(CLI::Range(1, 1000))->capture_default_str();
  verb->add_option("--device", options->device, "As for run")->capture_default_str();
  verb->add_flag("--json", options->json, "As JSON");
  verb->callback([&action, options] { action = [options] { return bench(*options); }; });
}

}  // namespace firn::app
