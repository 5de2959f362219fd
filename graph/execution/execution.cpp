#include "graph/execution/execution.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "graph/execution/host_context.h"
#include "graph/execution/kernels.h"
#include "graph/execution/programs.h"
#include "graph/execution/sizes.h"
#include "graph/repeats.h"

namespace firn::execution {
namespace {

using graph::Bits;
using graph::Op;
using graph::Plan;
using graph::PlannedBuffer;
using graph::PlannedStage;

static_assert(static_cast<std::uint32_t>(gpu::BarrierBit::shader_storage) == graph::bit_shader_storage &&
                  static_cast<std::uint32_t>(gpu::BarrierBit::vertex_attrib_array) == graph::bit_vertex_attrib_array &&
                  static_cast<std::uint32_t>(gpu::BarrierBit::buffer_update) == graph::bit_buffer_update &&
                  static_cast<std::uint32_t>(gpu::BarrierBit::texture_fetch) == graph::bit_texture_fetch &&
                  static_cast<std::uint32_t>(gpu::BarrierBit::command) == graph::bit_command,
              "plan bits are passed on as they are");

constexpr std::int64_t most_works = 1024;  // of one stage

struct ClockBlock {  // std140, as graph/glsl.cpp declares it
  float dt = 0, time = 0;
  std::uint32_t step = 0, frame = 0;
};

template <typename T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace

struct Execution::Parts {
  gpu::Device& device;
  Plan plan;  // as it stands (sizes.h)
  Options options;
  graph::Clock clock;
  Memory memory;
  std::vector<std::vector<Kernel>> kernels;  // by stage, by work
  std::vector<gpu::Buffer> parameters;       // by stage
  Sizes sizes;
  std::vector<std::unique_ptr<graph::HostStage>> host;  // by stage; empty where it has no host work
  gpu::Buffer clock_block;
  gpu::Buffer faults;           // per stage and kind: count, 0xffffffff - first step
  std::vector<std::byte> read;  // by read_back()
  bool timing = false;
  std::unique_ptr<gpu::TimerRing> timers;  // made when first needed; never on software renderers
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  double ring_made = 0;  // s since `begin`
  std::vector<PassTime> clock_times;
  std::optional<std::vector<PassGroups>> counted;  // none: groups are not counted now
  struct Turns {
    std::uint64_t rounds = 0, turns = 0;
  };
  std::map<const graph::Repeat*, Turns> turns;  // as issued; where the device decides, it alone knows how many did something

  Parts(gpu::Device& device_, Plan plan_, const graph::Registry& registry, Options options_)
      : device(device_),
        plan(std::move(plan_)),
        options(std::move(options_)),
        memory(plan, device),
        sizes(plan, memory, kernels, parameters) {
    clock_block = gpu::Buffer(sizeof(ClockBlock), "clock");
    faults = gpu::Buffer(plan.stages.size() * graph::fault_kinds * 2 * sizeof(std::uint32_t), "faults");
    for (int s = 0; s < static_cast<int>(plan.stages.size()); ++s) {
      const PlannedStage& stage = plan.stages[static_cast<std::size_t>(s)];
      device.label(stage.label.c_str());
      parameters.emplace_back(graph::parameter_block(plan, s).size(), stage.label + " parameters");
      sizes.upload_parameters(s);
      std::vector<Kernel>& of_stage = kernels.emplace_back();
      bool has_host_work = false;
      for (int w = 0; w < static_cast<int>(stage.spec.work.size()); ++w) {
        of_stage.push_back(make_kernel(plan, s, w, memory, device));
        has_host_work |= std::holds_alternative<graph::HostWork>(stage.spec.work[static_cast<std::size_t>(w)]);
      }
      host.push_back(has_host_work ? registry.find(stage.spec.name)->host(stage.parameters) : nullptr);
    }
    std::optional<gpu::ProgramCache> cache;
    if (!options.program_cache.empty())
      cache.emplace(options.program_cache, [](const std::string& what) { spdlog::debug("cache of programs: {}", what); });
    make_programs(plan, kernels, device, options.shader_folders, cache ? &*cache : nullptr, [this](int s, int w) {
      const auto stage = static_cast<std::size_t>(s);
      rehearse_kernel(plan.stages[stage], w, kernels[stage][static_cast<std::size_t>(w)], memory, blocks(stage));
    });
    time_passes(options.profile);
  }

  [[nodiscard]] StageBlocks blocks(std::size_t stage) const { return {parameters[stage], clock_block, faults}; }

  void time_passes(bool on) {
    if (on && !timing) device.finish();  // so that no pass waits for earlier work, nor the ring's start is later than the clock's
    timing = on;
    if (!on || timers || device.info().software) return;
    timers = std::make_unique<gpu::TimerRing>(4096);
    ring_made = now();
  }

  // Step, stage and work in one number, and back.
  [[nodiscard]] std::int64_t tag_of(const graph::Run& run) const {
    const auto stages = static_cast<std::int64_t>(plan.stages.size());
    return (static_cast<std::int64_t>(clock.step) * stages + run.stage) * most_works + run.work;
  }
  [[nodiscard]] PassTime pass_of(const gpu::TimerRing::Sample& sample) const {
    const auto stages = static_cast<std::int64_t>(plan.stages.size());
    const std::int64_t stage = sample.tag / most_works;
    return {static_cast<int>(stage % stages), static_cast<int>(sample.tag % most_works), static_cast<std::uint64_t>(stage / stages),
            ring_made + sample.start, sample.seconds};
  }

  [[nodiscard]] double now() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); }

  void upload_clock() {
    const ClockBlock block{static_cast<float>(clock.dt), static_cast<float>(clock.time), static_cast<std::uint32_t>(clock.step),
                           static_cast<std::uint32_t>(clock.frame)};
    clock_block.upload(0, bytes_of(block));
  }

  void run(const std::vector<Op>& ops, std::uint64_t turn) {
    for (const Op& op : ops) {
      if (const auto* barrier = std::get_if<graph::Barrier>(&op.what)) {
        if (!options.barriers_all) gpu::memory_barrier(barrier->bits);
      } else if (const auto* run = std::get_if<graph::Run>(&op.what)) {
        work(*run, turn);
      } else if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
        Turns& made = turns[repeat];
        ++made.rounds;
        for (std::int64_t i = 0; i < repeat->max; ++i) {
          ++made.turns;
          this->run(repeat->body, turn);
          if (repeat->until && repeat->until->progress < 0 && reached(*repeat->until)) break;
        }
      }
    }
  }

  [[nodiscard]] bool reached(const graph::PlannedUntil& until) {
    const PlannedBuffer& watched = plan.buffers[static_cast<std::size_t>(until.buffer)];
    const auto all = [&]<typename T>(T, auto limit) {
      const std::span<std::byte> bytes = read_back(memory.buffer(until.buffer), watched.count * sizeof(T));
      return std::ranges::all_of(std::span(reinterpret_cast<const T*>(bytes.data()), watched.count), limit);
    };
    const std::int64_t largest = graph::largest_below(until.below);
    const auto whole = [&](auto value) { return std::int64_t{value} <= largest; };
    if (watched.type == graph::ElementType::int1) return all(std::int32_t{}, whole);
    if (watched.type == graph::ElementType::uint1) return all(std::uint32_t{}, whole);
    return all(0.0F, [&](float value) { return value < static_cast<float>(until.below); });
  }

  // The same memory each time.
  std::span<std::byte> read_back(const gpu::Buffer& buffer, std::size_t bytes) {
    if (read.size() < bytes) read.resize(bytes);
    const std::span<std::byte> part = std::span(read).first(bytes);
    buffer.download(0, part);
    return part;
  }

  void work(const graph::Run& run, std::uint64_t turn);

  void note_groups(const graph::Run& run) {
    for (const graph::BufferAccess& access : run.accesses) {
      if (access.usage != graph::Usage::indirect) continue;
      std::array<std::uint32_t, 3> groups{};
      gpu::memory_barrier(graph::bit_buffer_update);
      memory.buffer(access.buffer).download(0, std::as_writable_bytes(std::span(groups)));
      counted->push_back({run.stage, run.work, std::uint64_t{groups[0]} * groups[1] * groups[2]});
    }
  }
};

void Execution::Parts::work(const graph::Run& run, std::uint64_t turn) {
  const auto s = static_cast<std::size_t>(run.stage);
  const PlannedStage& stage = plan.stages[s];
  if (turn % static_cast<std::uint64_t>(stage.every) != 0) return;
  device.label(stage.label.c_str());
  const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
  if (std::holds_alternative<graph::HostWork>(work)) {
    const double before = clock.dt, start = now();
    PlanContext context(stage, plan, memory, sizes, clock);
    host[s]->run(context);
    if (timing) clock_times.push_back({run.stage, run.work, clock.step, start, now() - start});
    if (clock.dt != before) upload_clock();
    return;
  }
  const Kernel& kernel = kernels[s][static_cast<std::size_t>(run.work)];
  if (kernel.idle) return;
  if (counted) note_groups(run);
  // A software renderer's timestamps say nothing of draws, which it does later, nor of what comes between: there it is the clock.
  const bool by_clock = timing && !timers;
  const double start = timing ? now() : 0;
  if (timing && timers) timers->begin(tag_of(run));
  run_kernel(stage, run, kernel, memory, blocks(s));
  if (timing && timers) timers->end();
  if (by_clock) {
    // Draws are only noted down by their call; a dispatch is over when its call returns.
    if (std::holds_alternative<graph::Draw>(work)) device.finish();
    clock_times.push_back({run.stage, run.work, clock.step, start, now() - start});
  }
  if (options.barriers_all) gpu::memory_barrier_all();
}

Execution::Execution(gpu::Device& device, Plan plan, const graph::Registry& registry, Options options) {
  std::vector<std::string> missing = shortcomings(plan, device.info().limits);
  for (std::string& extension : missing_extensions(plan, traits_of(device))) missing.push_back(std::move(extension));
  if (!missing.empty())
    throw gpu::DeviceError(fmt::format("{} cannot run {}:\n  {}", device.info().name, plan.pipeline, fmt::join(missing, "\n  ")));
  parts_ = std::make_unique<Parts>(device, std::move(plan), registry, std::move(options));
}

Execution::~Execution() = default;

void Execution::setup() {
  parts_->upload_clock();
  parts_->run(parts_->plan.setup, 0);
  parts_->device.check();
}

void Execution::step() {
  graph::Clock& clock = parts_->clock;
  parts_->upload_clock();
  parts_->run(parts_->plan.step, clock.step);
  parts_->device.check();
  clock.time += clock.dt;
  ++clock.step;
}

void Execution::frame() {
  parts_->upload_clock();
  parts_->run(parts_->plan.frame, parts_->clock.frame);
  parts_->device.check();
  ++parts_->clock.frame;
}

void Execution::finish() {
  for (const auto& stage : parts_->host)
    if (stage) stage->finish();
}

void Execution::flush() {
  check_faults();
  for (const auto& stage : parts_->host)
    if (stage) stage->flush();
}

void Execution::resume(const graph::Clock& clock) {
  parts_->clock = clock;
  for (const auto& stage : parts_->host)
    if (stage) stage->resume(clock);
}

void Execution::check_faults() {
  const std::size_t slots = parts_->plan.stages.size() * graph::fault_kinds;
  if (slots == 0) return;
  gpu::memory_barrier(graph::bit_buffer_update);
  const std::span<std::byte> bytes = parts_->read_back(parts_->faults, 2 * slots * sizeof(std::uint32_t));
  const std::span words(reinterpret_cast<const std::uint32_t*>(bytes.data()), 2 * slots);
  std::size_t worst = slots;
  for (std::size_t i = 0; i < slots; ++i)
    if (words[2 * i] > 0 && (worst == slots || words[2 * i + 1] > words[2 * worst + 1])) worst = i;
  if (worst == slots) return;
  const PlannedStage& stage = parts_->plan.stages[worst / graph::fault_kinds];
  const auto kind = static_cast<graph::Fault>(worst % graph::fault_kinds);
  throw NumbersError(fmt::format("{} found {} in step {} ({} {})", stage.label, graph::describe(kind),
                                 0xffffffffu - words[2 * worst + 1], words[2 * worst], words[2 * worst] == 1 ? "case" : "cases"));
}

void Execution::resize(const std::string& domain, std::uint64_t count) { parts_->sizes.set(domain, count); }

graph::Clock& Execution::clock() { return parts_->clock; }
const Plan& Execution::plan() const { return parts_->plan; }

std::vector<std::byte> Execution::read(const std::string& name) const {
  const int index = parts_->plan.buffer(name);
  if (index < 0) throw std::out_of_range(fmt::format("no buffer '{}'", name));
  const auto b = static_cast<std::size_t>(index);
  if (parts_->plan.buffers[b].texture) return parts_->memory.textures[b].download();
  gpu::memory_barrier(graph::bit_buffer_update);
  std::vector<std::byte> data(parts_->plan.buffers[b].bytes);
  parts_->memory.buffer(index).download(0, data);
  return data;
}

void Execution::write(const std::string& name, std::span<const std::byte> data) {
  const int index = parts_->plan.buffer(name);
  if (index < 0) throw std::out_of_range(fmt::format("no buffer '{}'", name));
  if (const auto b = static_cast<std::size_t>(index); parts_->plan.buffers[b].texture) {
    gpu::memory_barrier(graph::bit_texture_update);
    parts_->memory.textures[b].upload(data);
    return;
  }
  gpu::memory_barrier(graph::bit_buffer_update);
  parts_->memory.buffer(index).upload(0, data);
}

std::vector<RepeatTurns> Execution::turns() const {
  std::vector<RepeatTurns> list;
  const std::function<void(const std::vector<Op>&)> visit = [&](const std::vector<Op>& ops) {
    for (const Op& op : ops)
      if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
        const auto made = parts_->turns.find(repeat);
        RepeatTurns entry{repeat->place, repeat->max, 0, 0};
        if (made != parts_->turns.end()) entry = {repeat->place, repeat->max, made->second.rounds, made->second.turns};
        if (repeat->until && repeat->until->progress >= 0) {
          std::array<std::uint32_t, graph::progress_size> words{};
          gpu::memory_barrier(graph::bit_buffer_update);
          parts_->memory.buffer(repeat->until->progress).download(0, std::as_writable_bytes(std::span(words)));
          entry.turns = words[graph::progress_turns];
        }
        list.push_back(entry);
        visit(repeat->body);
      }
  };
  for (const std::vector<Op>* phase : {&parts_->plan.setup, &parts_->plan.step, &parts_->plan.frame}) visit(*phase);
  return list;
}

std::vector<PassGroups> Execution::step_counting_groups() {
  parts_->counted.emplace();
  step();
  return std::move(*std::exchange(parts_->counted, std::nullopt));
}

void Execution::time_passes(bool on) { parts_->time_passes(on); }

std::vector<PassTime> Execution::take_times(bool wait) {
  std::vector<PassTime> times;
  std::swap(times, parts_->clock_times);
  if (!parts_->timers) return times;
  for (const gpu::TimerRing::Sample& sample : parts_->timers->collect(wait)) times.push_back(parts_->pass_of(sample));
  return times;
}

}  // namespace firn::execution
