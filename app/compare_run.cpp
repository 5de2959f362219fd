#include "app/compare_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <numeric>
#include <set>

#include "app/arrays.h"
#include "app/device_profile.h"
#include "app/explain.h"
#include "app/program_cache.h"
#include "app/progress.h"

namespace firn::app {
namespace {

// The passes of a plan, with places for their times.
class Stopwatch {
 public:
  explicit Stopwatch(const graph::Plan& plan) {
    add(plan, "setup", plan.setup);
    add(plan, "step", plan.step);
    add(plan, "frame", plan.frame);
  }

  void note(const std::vector<execution::PassTime>& times) {
    for (const execution::PassTime& time : times)
      if (const auto row = rows_.find({time.stage, time.work}); row != rows_.end())
        passes_[row->second].seconds.push_back(time.seconds);
  }

  [[nodiscard]] std::vector<PassTimes> passes() const {
    std::vector<PassTimes> timed = passes_;
    std::erase_if(timed, [](const PassTimes& pass) { return pass.seconds.empty(); });
    return timed;
  }

 private:
  void add(const graph::Plan& plan, const std::string& phase, const std::vector<graph::Op>& ops) {
    for (const graph::Op& op : ops) {
      if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) add(plan, phase, repeat->body);
      const auto* run = std::get_if<graph::Run>(&op.what);
      if (run == nullptr || !rows_.emplace(std::pair{run->stage, run->work}, passes_.size()).second) continue;
      const graph::PlannedStage& stage = plan.stages[static_cast<std::size_t>(run->stage)];
      passes_.push_back({phase, stage.label, work_name(stage.spec.work[static_cast<std::size_t>(run->work)]), {}});
    }
  }

  std::map<std::pair<int, int>, std::size_t> rows_;
  std::vector<PassTimes> passes_;
};

std::vector<Mass> masses_of(const Side& side, const graph::Environment& environment) {
  std::vector<Mass> masses;
  const auto find = [&](const char* name, const char* domain) -> const Contents* {
    const auto found = side.buffers.find(name);
    return found != side.buffers.end() && found->second.domain == domain ? &found->second : nullptr;
  };
  if (const Contents* mass = find("mass", "particles")) {
    double sum = 0;
    for (std::size_t i = 0; i < mass->scalars(); ++i) sum += mass->value(i);
    masses.push_back({"particles", sum});
  }
  const Contents *depth = find("depth", "cells"), *density = find("density", "cells");
  const graph::Constant* cell = environment.constant("field_cell");
  if (depth != nullptr && density != nullptr && cell != nullptr) {
    const double edge = std::get<double>(cell->value);
    double sum = 0;
    for (std::size_t i = 0; i < depth->scalars(); ++i) sum += depth->value(i) * density->value(i) * edge * edge;
    masses.push_back({"the field", sum});
  }
  return masses;
}

// What only one stage works with is its own affair, and what differs from run to run tells nothing.
bool is_comparable(const graph::Plan& plan, int buffer) {
  std::set<std::string> stages;
  for (const graph::PlannedStage& stage : plan.stages)
    for (std::size_t p = 0; p < stage.buffers.size(); ++p)
      if (stage.buffers[p] == buffer) {
        stages.insert(stage.spec.name);
        if (!stage.spec.ports[p].repeatable) return false;
      }
  return stages.size() > 1;
}

void take_state(Side& side, execution::Execution& execution) {
  const graph::Plan& plan = execution.plan();
  for (int b = 0; b < static_cast<int>(plan.buffers.size()); ++b) {
    const graph::PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(b)];
    if (!buffer.texture && buffer.lifetime == graph::Lifetime::state && buffer.count > 0 && is_comparable(plan, b)) {
      Array array = read_array(execution, buffer.name);
      side.buffers[buffer.name] = {buffer.type, std::move(array.domain), buffer.unit, std::move(array.packed)};
    }
  }
  side.masses = masses_of(side, plan.environment);
  const int image = plan.buffer("image");
  if (image < 0 || plan.frame.empty()) return;
  execution.frame();
  const graph::PlannedBuffer& picture = plan.buffers[static_cast<std::size_t>(image)];
  if (picture.texture && picture.type == graph::ElementType::rgba8)
    side.picture = stages::picture_of(execution.read("image"), picture.width, picture.height);
}

}  // namespace

double PassTimes::total() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

double Contents::value(std::size_t scalar) const {
  const auto as = [&]<typename T>(T number) {
    std::memcpy(&number, packed.data() + scalar * sizeof(T), sizeof(T));
    return static_cast<double>(number);
  };
  switch (graph::scalar(type)) {
    case graph::Scalar::integer:
      return as(std::int32_t{});
    case graph::Scalar::natural:
      return as(std::uint32_t{});
    default:
      return as(0.0F);
  }
}

std::string Side::title() const {
  return changes.empty() ? fmt::format("{}: {}", letter, pipeline) : fmt::format("{}: {}, {}", letter, pipeline, changes);
}

double Side::milliseconds_per_step() const {
  double sum = 0;
  for (const PassTimes& pass : passes)
    if (pass.phase == "step") sum += pass.total();
  return steps > 0 ? 1e3 * sum / static_cast<double>(steps) : 0;
}

Side run_side(const std::string& letter, const Inputs& inputs, const std::string& changes, Loaded loaded, gpu::Device& device,
              const Until& until, bool quiet) {
  plan_for(loaded, inputs, profile_of(device));
  Side side;
  side.letter = letter;
  side.pipeline = loaded.pipeline.name;
  side.changes = changes;
  side.device_bytes = loaded.plan.bytes;
  const scene::Time& time = loaded.problem->scene.time;
  Stopwatch stopwatch(loaded.plan);
  execution::Execution execution(device, loaded.plan, loaded.registry, {shader_folders(), false, true, program_cache_folder()});
  Progress progress(until.steps    ? static_cast<double>(*until.steps)
                    : until.frames ? static_cast<double>(*until.frames)
                                   : time.end,
                    quiet);
  const auto start = std::chrono::steady_clock::now();
  try {
    const Ending ending = simulate(execution, time, until, device.info().software, [&](const graph::Clock& clock) {
      stopwatch.note(execution.take_times());
      progress.update(until.steps    ? static_cast<double>(clock.step)
                      : until.frames ? static_cast<double>(clock.frame)
                                     : clock.time,
                      clock.frame, clock.step);
    });
    side.interrupted = ending == Ending::interrupted;
  } catch (const execution::NumbersError& error) {
    throw execution::NumbersError(fmt::format("{}: {}", side.title(), error.what()));
  }
  progress.finish();
  stopwatch.note(execution.take_times());
  side.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  side.passes = stopwatch.passes();
  side.steps = execution.clock().step;
  side.frames = execution.clock().frame;
  side.simulated = execution.clock().time;
  if (!side.interrupted) take_state(side, execution);
  return side;
}

}  // namespace firn::app
