// Particles to grid and back, each form by itself: a cube of particles that rests, in memory by cells or at random.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "app/bench.h"

namespace firn::app {
namespace {

struct Form {
  std::string name, pipeline;
  std::vector<std::string> set;
  // What counts, by the stages' names: "particles_to_grid" -> stages.
  std::vector<std::pair<std::string, std::vector<std::string>>> parts;
};

std::vector<Form> forms() {
  const std::vector<std::string> scattered{"mpm.clear_grid", "mpm.particles_to_grid", "mpm.grid_forces"};
  const std::vector<std::string> gathered{"mpm.gather_velocities"}, back{"mpm.grid_to_particles"};
  return {
      {"atomics_fixed", "transfers_atomics", {"accumulate=fixed"}, {{"particles_to_grid", scattered}, {"grid_to_particles", back}}},
      {"atomics_float", "transfers_atomics", {"accumulate=float"}, {{"particles_to_grid", scattered}}},
      {"texture",
       "transfers_gathered",
       {"form=texture", "nodes=by_cell"},
       {{"particles_to_grid", gathered}, {"grid_to_particles", back}, {"sort", {"mpm.sort"}}}},
      {"shared",
       "transfers_gathered",
       {"form=shared", "nodes=by_block"},
       {{"particles_to_grid", gathered}, {"grid_to_particles", back}}},
      {"subgroup", "transfers_gathered", {"form=subgroup", "nodes=by_block"}, {{"particles_to_grid", gathered}}},
  };
}

// The scene's particles in another order in memory: by cell, x fastest, or thrown about.
void reorder(Loaded& loaded, bool by_cell) {
  auto problem = std::make_shared<stages::Problem>(*loaded.problem);
  scene::Particles& particles = problem->particles;
  std::vector<std::size_t> order(particles.position.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (by_cell) {
    const scene::Domain& domain = *problem->scene.domain;
    const Eigen::Vector3i nodes = domain.nodes();
    std::vector<std::int64_t> cells;
    for (const scene::Vector3d& position : particles.position) {
      const Eigen::Vector3i at = ((position - domain.min) / domain.cell).array().floor().cast<int>();
      cells.push_back((std::int64_t{at.z()} * nodes.y() + at.y()) * nodes.x() + at.x());
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return cells[i]; });
  } else {
    std::ranges::shuffle(order, std::mt19937_64(1));
  }
  const auto apply = [&](auto& values) {
    auto reordered = values;
    for (std::size_t i = 0; i < order.size(); ++i) reordered[i] = values[order[i]];
    values = std::move(reordered);
  };
  apply(particles.position);
  apply(particles.velocity);
  apply(particles.mass);
  apply(particles.volume);
  apply(particles.material);
  loaded.problem = problem;
  loaded.registry = stages::all_stages(problem);
}

struct Running {
  Form form;
  std::string order;
  std::unique_ptr<BenchRun> run;
  int steps = 1;
  std::map<std::string, std::vector<double>> seconds;  // by part, one per run
};

void time_parts(Running& running) {
  execution::Execution& execution = *running.run->execution;
  execution.take_times();
  running.run->steps(running.steps);
  std::map<std::string, double> of_stage;
  for (const execution::PassTime& pass : execution.take_times())
    of_stage[execution.plan().stages[static_cast<std::size_t>(pass.stage)].spec.name] += pass.seconds / running.steps;
  for (const auto& [part, stages] : running.form.parts) {
    double sum = 0;
    for (const std::string& stage : stages) sum += of_stage[stage];
    running.seconds[part].push_back(sum);
  }
}

}  // namespace

void bench_transfers(Bench& bench) {
  // A quarter of the cube's edge less is 1/64 of its particles.
  const std::vector<std::string> size =
      bench.small() ? std::vector<std::string>{"scene.snow.0.box.size=[2.5, 2.5, 2.5]", "scene.domain.max=[12.7, 12.7, 12.7]"}
                    : std::vector<std::string>{};
  std::vector<Running> all;
  for (const Form& form : forms())
    for (const std::string order : {"sorted", "random"}) {
      const auto name = [&](const std::string& part) { return fmt::format("transfers/{}/{}/{}", part, form.name, order); };
      Running running{form, order, nullptr, 1, {}};
      std::erase_if(running.form.parts, [&](const auto& part) { return !bench.wants(name(part.first)); });
      if (running.form.parts.empty()) continue;
      std::vector<std::string> set = form.set;
      set.insert(set.end(), size.begin(), size.end());
      const auto reason = why_not([&] {
        running.run = std::make_unique<BenchRun>(form.pipeline, "cube", set, bench.device(), false,
                                                 [&](Loaded& loaded) { reorder(loaded, order == "sorted"); });
        running.run->steps(1);
        const double seconds = running.run->steps(1);
        running.steps = std::clamp(static_cast<int>((bench.small() ? 0.05 : 0.3) / seconds), 1, 500);
        running.run->execution->time_passes(true);
      });
      if (!reason) {
        all.push_back(std::move(running));
        continue;
      }
      for (const auto& [part, stages] : running.form.parts) bench.not_possible(name(part), *reason);
    }
  for (int run = 0; run < bench.runs(); ++run)
    for (Running& running : all) time_parts(running);
  // Forms of one part stand beside each other.
  for (const std::string part : {"particles_to_grid", "grid_to_particles", "sort"})
    for (const Running& running : all) {
      const auto found = running.seconds.find(part);
      if (found == running.seconds.end()) continue;
      BenchResult result{fmt::format("transfers/{}/{}/{}", part, running.form.name, running.order), found->second};
      result.count = static_cast<double>(running.run->loaded.problem->particles.position.size());
      result.unit = "particles/s";
      bench.add(result);
    }
}

}  // namespace firn::app
