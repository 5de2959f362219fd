#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <map>
#include <numeric>

#include "app/explain.h"
#include "app/profile.h"
#include "app/program_cache.h"
#include "app/statistics.h"

namespace firn::app {
namespace {

using graph::BufferAccess;
using graph::Plan;
using graph::PlannedBuffer;

// A piece of work of the plan, and whether a repeat holds it whose end the device finds.
struct Planned {
  const graph::Run* run = nullptr;
  bool device_ends = false;
};

void collect(const std::vector<graph::Op>& ops, bool device_ends, std::vector<Planned>& list) {
  for (const graph::Op& op : ops) {
    if (const auto* run = std::get_if<graph::Run>(&op.what)) list.push_back({run, device_ends});
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what))
      collect(repeat->body, device_ends || (repeat->until && repeat->until->progress >= 0), list);
  }
}

// The groups of an indirect dispatch, read back. Nothing where they may be gone: others use the same memory, or the end of a repeat
// has zeroed them.
std::optional<std::uint64_t> indirect_groups(const execution::Execution& execution, const Planned& planned) {
  const Plan& plan = execution.plan();
  for (const BufferAccess& access : planned.run->accesses) {
    if (access.usage != graph::Usage::indirect) continue;
    const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(access.buffer)];
    if (planned.device_ends || std::ranges::count(plan.buffers, buffer.storage, &PlannedBuffer::storage) > 1) return std::nullopt;
    const std::vector<std::byte> data = execution.read(buffer.name);
    std::array<std::uint32_t, 3> groups{};
    if (data.size() < sizeof(groups)) return std::nullopt;
    std::memcpy(groups.data(), data.data(), sizeof(groups));
    return std::uint64_t{groups[0]} * groups[1] * groups[2];
  }
  return std::nullopt;
}

// The share of every buffer that an indirect dispatch of `invocations` touches: its elements are those of the largest buffer that
// it writes; other domains are touched as a whole.
struct Walked {
  std::string domain;
  double share = 1;
};
Walked walked_by(const Plan& plan, const graph::Run& run, std::uint64_t invocations) {
  Walked walked;
  std::uint64_t most = 0;
  for (const BufferAccess& access : run.accesses) {
    const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(access.buffer)];
    if (!graph::writes(access.access) || buffer.count <= most) continue;
    most = buffer.count;
    const std::string domain = graph::base_domain(buffer.domain);
    walked = {domain, std::min(1.0, static_cast<double>(invocations) / static_cast<double>(buffer.count))};
  }
  return walked;
}

ProfiledPass describe(const execution::Execution& execution, const Planned& planned) {
  const Plan& plan = execution.plan();
  const graph::Run& run = *planned.run;
  const graph::PlannedStage& stage = plan.stages[static_cast<std::size_t>(run.stage)];
  const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
  ProfiledPass pass{stage.label, stage.spec.doc, stage.spec.equation, work_name(work), "", {}, {}, false};
  Walked walked;
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) {
    if (!dispatch->needs.empty() && graph::element_count(dispatch->needs, plan.environment) == 0) {
      pass.elements = fmt::format("left out, as there are no {}", dispatch->needs);
      return pass;
    }
    if (dispatch->indirect.empty()) {
      pass.elements =
          fmt::format("over {}, {}", dispatch->over, graph::element_count(dispatch->over, plan.environment).value_or(0));
    } else if (const std::optional<std::uint64_t> groups = indirect_groups(execution, planned)) {
      pass.elements = fmt::format("over {} groups of {}, read back once", *groups, dispatch->group);
      walked = walked_by(plan, run, *groups * static_cast<std::uint64_t>(dispatch->group));
    } else {
      pass.elements = "over as many groups as the device finds, which cannot be read back; bytes as if all";
    }
  } else if (const auto* draw = std::get_if<graph::Draw>(&work)) {
    const std::uint64_t instances = graph::element_count(draw->instances, plan.environment).value_or(0);
    pass.elements = fmt::format("{} times {} vertices", instances, draw->vertices);
    if (instances == 0 && !draw->clear) return pass;  // nothing is touched
  } else {
    pass.host = true;
    pass.elements = "on the processor";
  }
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work))
    for (const graph::Arithmetic& one : dispatch->arithmetic)
      pass.operations = pass.operations.value_or(0) +
                        one.operations * static_cast<double>(graph::element_count(one.per, plan.environment).value_or(0));
  for (const BufferAccess& access : run.accesses) {
    const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(access.buffer)];
    const bool part = !walked.domain.empty() && graph::base_domain(buffer.domain) == walked.domain;
    const double bytes = static_cast<double>(buffer.bytes) * (part ? walked.share : 1);
    pass.traffic.push_back({buffer.name, std::string(name(access.access)), std::string(name(access.usage)),
                            graph::reads(access.access) ? bytes : 0, graph::writes(access.access) ? bytes : 0});
  }
  return pass;
}

class Run {
 public:
  Run(const Loaded& loaded, gpu::Device& device)
      : device_(device),
        execution_(device, loaded.plan, loaded.registry, {shader_folders(), false, false, program_cache_folder()}),
        time_(loaded.problem->scene.time) {
    execution_.setup();
  }

  // The seconds of so many steps.
  double steps(std::uint64_t count, bool timed) {
    execution_.time_passes(timed);
    device_.finish();
    const auto start = std::chrono::steady_clock::now();
    for (std::uint64_t i = 0; i < count; ++i) {
      execution_.clock().dt = time_.dt.value_or(1.0 / time_.fps);
      execution_.step();
      if (timed) keep(execution_.take_times(false));
    }
    device_.finish();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (timed) keep(execution_.take_times(true));
    return seconds;
  }

  [[nodiscard]] execution::Execution& execution() { return execution_; }
  [[nodiscard]] const std::vector<execution::PassTime>& times() const { return times_; }

 private:
  void keep(const std::vector<execution::PassTime>& times) { times_.insert(times_.end(), times.begin(), times.end()); }

  gpu::Device& device_;
  execution::Execution execution_;
  scene::Time time_;
  std::vector<execution::PassTime> times_;
};

}  // namespace

double ProfiledPass::total() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

double ProfiledPass::bytes() const {
  double sum = 0;
  for (const Traffic& one : traffic) sum += one.read + one.written;
  return sum;
}

double ProfiledPass::bytes_per_second() const {
  const double middle = median(seconds);
  return middle > 0 && !host ? bytes() / middle : 0;
}

std::optional<double> ProfiledPass::operations_per_second() const {
  const double middle = median(seconds);
  return operations && middle > 0 ? std::optional(*operations / middle) : std::nullopt;
}

double Profile::share_of_copy(const ProfiledPass& pass) const {
  return speed.bandwidth() > 0 ? pass.bytes_per_second() / speed.bandwidth() : 0;
}

std::optional<double> Profile::share_of_arithmetic(const ProfiledPass& pass) const {
  const std::optional<double> rate = pass.operations_per_second();
  return rate && speed.multiply_add > 0 ? std::optional(*rate / speed.multiply_add) : std::nullopt;
}

double Profile::total() const {
  double sum = 0;
  for (const ProfiledPass& pass : passes) sum += pass.total();
  return sum;
}

std::string Profile::held_back_by(const ProfiledPass& pass) const {
  if (pass.host) return "the processor";
  if (median(pass.seconds) <= 2 * speed.launch) return "launching";
  const double bytes = share_of_copy(pass), arithmetic = share_of_arithmetic(pass).value_or(0);
  if (arithmetic >= 0.6 && (arithmetic > bytes || bytes > 1.1)) return "arithmetic";
  if (bytes > 1.1) return "unclear";
  if (bytes >= 0.6) return "bytes";
  return "its own work";
}

Profile run_profile(const Loaded& loaded, gpu::Device& device, const ProfileRequest& request) {
  Profile profile;
  profile.pipeline = loaded.pipeline.name;
  profile.scene = loaded.problem->scene.name.empty() ? loaded.scene_file : loaded.problem->scene.name;
  profile.device = device.info().name;
  profile.clock = device.info().software ? "the processor's clock, each pass waited for: this software renderer's timestamps say "
                                           "nothing of draws"
                                         : "the device's timestamps";
  profile.steps = request.steps;
  profile.speed = measure_speed(device);

  Run run(loaded, device);
  run.steps(request.warm_up, false);
  std::vector<Planned> planned;
  collect(run.execution().plan().step, false, planned);
  std::map<std::pair<int, int>, std::size_t> rows;
  for (const Planned& one : planned)
    if (rows.emplace(std::pair{one.run->stage, one.run->work}, profile.passes.size()).second)
      profile.passes.push_back(describe(run.execution(), one));

  // With and without in turn, in short blocks, so that what else the machine does weighs on both alike.
  constexpr std::uint64_t block = 10;
  std::vector<double> with, without;
  double wall = 0;
  for (std::uint64_t done = 0; done < request.steps;) {
    const std::uint64_t count = std::min(block, request.steps - done);
    if (request.cost) without.push_back(run.steps(count, false) / static_cast<double>(count));
    const double seconds = run.steps(count, true);
    with.push_back(seconds / static_cast<double>(count));
    wall += seconds;
    done += count;
  }
  run.execution().check_faults();
  profile.wall = wall / static_cast<double>(request.steps);
  if (request.cost) profile.cost = median(with) / median(without) - 1;

  std::map<std::uint64_t, std::uint64_t> numbers;  // of steps: those between, untimed, do not count
  std::vector<execution::PassTime> times = run.times();
  std::ranges::stable_sort(times, {}, &execution::PassTime::start);
  for (const execution::PassTime& time : times) {
    const auto row = rows.find({time.stage, time.work});
    if (row == rows.end()) continue;
    profile.passes[row->second].seconds.push_back(time.seconds);
    const std::uint64_t step = numbers.emplace(time.step, numbers.size()).first->second;
    profile.launches.push_back({row->second, step, time.start, time.seconds});
  }
  const double first = profile.launches.empty() ? 0 : profile.launches.front().start;
  for (ProfiledLaunch& launch : profile.launches) launch.start -= first;
  return profile;
}

}  // namespace firn::app
