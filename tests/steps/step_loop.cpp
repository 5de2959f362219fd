// What the host does in a step, in calls of OpenGL and in memory taken; no clock is asked.

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>

#include "app/load.h"
#include "gpu/calls.h"
#include "graph/execution/execution.h"
#include "graph/glsl.h"
#include "tests/catch.h"
#include "tests/steps/allocations.h"

using namespace firn;

namespace {

gpu::Device& device() {
  static const std::unique_ptr<gpu::Device> one = gpu::Device::open();
  return *one;
}

struct Shipped {
  std::string pipeline, scene;
  std::vector<std::string> set;
  std::string repeats = "host";
};

// A few seconds for each: small scenes, and no pictures of them are made.
const Shipped shipped[] = {
    {"mpm_snow", "snowball", {"scene.time.dt=1e-4"}},
    {"mpm_thesis", "snowball", {"scene.time.dt=1e-4"}},
    {"mpm_apic", "snowball", {"scene.time.dt=1e-4"}},
    {"heightfield_contour", "ball_drag", {}},
    {"heightfield_contour", "ball_drag", {}, "device"},
    {"heightfield_distance", "ball_drag", {}},
    {"examples/velocity_damping", "snowball", {"scene.time.dt=1e-4"}},
    {"examples/melt", "ball_drag", {}},
    {"examples/wind_drift", "ball_drag", {}},
};

// Steps of automatic length, which the host reads back, and bodies that move, as told and by themselves.
const Shipped more_shipped[] = {
    {"mpm_snow", "snowball", {"scene.time.dt=auto"}}, {"mpm_thesis", "snowball", {"scene.time.dt=auto"}},
    {"heightfield_contour", "ball_drop", {}},         {"heightfield_contour", "plough", {}},
    {"heightfield_distance", "plough", {}},           {"heightfield_distance", "footprints", {}, "device"},
};

struct Run {
  explicit Run(const Shipped& what) {
    app::Inputs inputs;
    inputs.pipeline = std::string(FIRN_SOURCE_DIR) + "/pipelines/" + what.pipeline + ".yaml";
    inputs.scene = std::string(FIRN_SOURCE_DIR) + "/pipelines/scenes/" + what.scene + ".yaml";
    inputs.set = what.set;
    inputs.repeats = what.repeats;
    loaded = app::load(inputs, "");
    execution = std::make_unique<execution::Execution>(device(), loaded.plan, loaded.registry,
                                                       execution::Options{app::shader_folders(), false, false});
    execution->setup();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      const scene::Time& time = loaded.problem->scene.time;
      execution->clock().dt = time.dt.value_or(1 / time.fps);
      execution->step();
      execution->check_faults();
    }
  }

  app::Loaded loaded;
  std::unique_ptr<execution::Execution> execution;
};

bool decided_by_host(const graph::Repeat& repeat) { return repeat.until && repeat.until->progress < 0; }

// What a step issues, by the plan alone.
class Issued {
 public:
  using Turns = std::function<std::uint64_t(const graph::Repeat&)>;
  // Steps before have left bound what they bind, so that the second walk counts.
  Issued(const graph::Plan& plan, const Turns& turns) : plan_(plan) {
    for (int walk = 0; walk < 2; ++walk) {
      launches = barriers = reads = bindings = 0;
      bound_["change"] = faults;  // read between steps
      bind("change", clock);
      visit(plan.step, turns);
    }
  }

  std::uint64_t launches = 0, barriers = 0, reads = 0, bindings = 0;

 private:
  static constexpr int clock = -1, faults = -2, parameters = -3;  // blocks that are no buffers of the plan

  void bind(const std::string& point, int what) {
    const auto [at, is_new] = bound_.emplace(point, what);
    if (!is_new && at->second == what) return;
    at->second = what;
    ++bindings;
  }

  void visit(const std::vector<graph::Op>& ops, const Turns& turns) {
    for (const graph::Op& op : ops) {
      if (std::holds_alternative<graph::Barrier>(op.what)) ++barriers;
      if (const auto* run = std::get_if<graph::Run>(&op.what)) visit(*run);
      if (const auto* repeat = std::get_if<graph::Repeat>(&op.what))
        for (std::uint64_t turn = 0; turn < turns(*repeat); ++turn) {
          visit(repeat->body, turns);
          if (!decided_by_host(*repeat)) continue;
          ++reads;
          bind("change", storage(repeat->until->buffer));
        }
    }
  }

  void visit(const graph::Run& run) {
    const graph::PlannedStage& stage = plan_.stages[static_cast<std::size_t>(run.stage)];
    const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
    if (std::holds_alternative<graph::HostWork>(work) || is_idle(work)) return;
    const bool launched = is_launched(work);
    launches += launched ? 1 : 0;
    const int program = 1000 * run.stage + run.work;
    bind("program", program);
    bind("uniform 0", parameters - run.stage);
    bind("uniform 1", clock);
    const graph::KernelInterface interface = graph::kernel_interface(plan_, run.stage, run.work, {});
    if (interface.fault_binding >= 0) bind(fmt::format("storage {}", interface.fault_binding), faults);
    for (const graph::PortBinding& port : interface.ports) {
      const int buffer = stage.buffers[static_cast<std::size_t>(port.port)];
      const graph::Usage usage = port.usage;
      if (usage == graph::Usage::storage) bind(fmt::format("storage {}", port.binding), storage(buffer));
      if (usage == graph::Usage::uniform) bind(fmt::format("uniform {}", port.binding), storage(buffer));
      if (usage == graph::Usage::indirect) bind("indirect", storage(buffer));
      if (usage == graph::Usage::image) bind(fmt::format("image {}", port.binding), buffer);
      if (usage == graph::Usage::sampled) bind(fmt::format("{} {}", port.texture ? "2d" : "texels", port.binding), buffer);
    }
    if (run.groups.buffer >= 0) bind("indirect", storage(run.groups.buffer));
    if (const auto* draw = std::get_if<graph::Draw>(&work); draw != nullptr && (launched || draw->clear)) bind("target", program);
  }

  [[nodiscard]] bool is_idle(const graph::Work& work) const {
    const auto* dispatch = std::get_if<graph::Dispatch>(&work);
    return dispatch != nullptr && !dispatch->needs.empty() && graph::element_count(dispatch->needs, plan_.environment) == 0;
  }

  // Nothing of no elements.
  [[nodiscard]] bool is_launched(const graph::Work& work) const {
    const auto count = [&](const std::string& domain) { return graph::element_count(domain, plan_.environment).value_or(0); };
    if (const auto* draw = std::get_if<graph::Draw>(&work)) return count(draw->instances) > 0 && count(draw->vertices) > 0;
    const auto& dispatch = std::get<graph::Dispatch>(work);
    return !dispatch.indirect.empty() || count(dispatch.over) > 0;
  }

  [[nodiscard]] int storage(int buffer) const { return plan_.buffers[static_cast<std::size_t>(buffer)].storage; }

  const graph::Plan& plan_;
  std::map<std::string, int> bound_;
};

std::map<std::string, std::uint64_t> turns_of(const execution::Execution& execution) {
  std::map<std::string, std::uint64_t> turns;
  for (const execution::RepeatTurns& repeat : execution.turns()) turns[config::to_string(repeat.place)] = repeat.turns;
  return turns;
}

std::uint64_t sum_of(const std::map<std::string, std::uint64_t>& calls, const std::function<bool(const std::string&)>& wanted) {
  std::uint64_t sum = 0;
  for (const auto& [name, number] : calls)
    if (wanted(name)) sum += number;
  return sum;
}

std::string text(const std::map<std::string, std::uint64_t>& calls) {
  std::string all;
  for (const auto& [name, number] : calls) all += fmt::format("{} {}, ", name, number);
  return all;
}

}  // namespace

TEST_CASE("a step takes no memory once the first is done") {
  const auto check = [](const Shipped& what) {
    Run run(what);
    run.steps(2);
    const std::uint64_t before = firn::test::allocations();
    run.steps(5);
    const std::uint64_t taken = firn::test::allocations() - before;
    INFO(what.pipeline << " on " << what.scene << ", repeats by " << what.repeats);
    CHECK(taken == 0);
  };
  for (const Shipped& what : shipped) check(what);
  for (const Shipped& what : more_shipped) check(what);
}

TEST_CASE("memory taken from the heap is counted") {
  const std::uint64_t before = firn::test::allocations();
  const std::unique_ptr<std::vector<double>> some = std::make_unique<std::vector<double>>(100);
  CHECK(firn::test::allocations() == before + 2);
}

TEST_CASE("a step makes one call a launch and a barrier, and others only for what is bound anew") {
  for (const Shipped& what : shipped) {
    Run run(what);
    run.steps(3);
    const std::map<std::string, std::uint64_t> turns_before = turns_of(*run.execution);
    std::map<std::string, std::uint64_t> calls;
    {
      const gpu::CallCounter counter;
      run.execution->clock().dt = run.loaded.problem->scene.time.dt.value();
      run.execution->step();
      calls = gpu::CallCounter::take();
    }
    const std::map<std::string, std::uint64_t> turns = turns_of(*run.execution);
    const graph::Plan& plan = run.execution->plan();
    const Issued issued(plan, [&](const graph::Repeat& repeat) {
      const std::string place = config::to_string(repeat.place);
      return decided_by_host(repeat) ? turns.at(place) - turns_before.at(place) : static_cast<std::uint64_t>(repeat.max);
    });
    const auto number = [&](const std::string& name) { return calls.contains(name) ? calls.at(name) : 0; };
    const std::uint64_t draws = number("glDrawArraysInstanced");
    const std::uint64_t launches = number("glDispatchCompute") + number("glDispatchComputeIndirect") + draws;
    const std::uint64_t clears = sum_of(calls, [](const std::string& name) { return name.starts_with("glClear"); });
    const std::uint64_t queries = sum_of(calls, gpu::is_query);
    const std::uint64_t binds =
        sum_of(calls, [](const std::string& name) { return name.starts_with("glBind") || name == "glUseProgram"; });
    const std::uint64_t all = sum_of(calls, [](const std::string&) { return true; });
    INFO(what.pipeline << " on " << what.scene << ", repeats by " << what.repeats << ": " << text(calls));
    CHECK(launches > 0);
    CHECK(launches == issued.launches);
    CHECK(number("glMemoryBarrier") == issued.barriers);
    CHECK(binds == issued.bindings);
    CHECK(number("glBufferSubData") == 1);  // the clock
    // The end of a repeat that the host decides: a value read back, and whether that went well.
    CHECK(number("glGetBufferSubData") == issued.reads);
    CHECK(queries <= 2 * issued.reads);
    CHECK(clears <= 2 * draws);  // colours and depth
    CHECK(all == launches + clears + issued.barriers + binds + queries + 1);
  }
}
