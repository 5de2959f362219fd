#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include "app/explain.h"
#include "app/profile.h"
#include "app/program_cache.h"
#include "app/statistics.h"

namespace firn::app {
namespace {

using graph::Plan;

void collect(const std::vector<graph::Op>& ops, std::vector<const graph::Run*>& list) {
  for (const graph::Op& op : ops) {
    if (const auto* run = std::get_if<graph::Run>(&op.what)) list.push_back(run);
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) collect(repeat->body, list);
  }
}

void describe(const Plan& plan, const graph::Dispatch& dispatch, std::optional<double> groups, ProfiledPass& pass) {
  const auto count = [&](const graph::DomainText& domain) { return graph::element_count(domain, plan.environment).value_or(0); };
  for (const graph::Arithmetic& one : dispatch.arithmetic)
    pass.operations = pass.operations.value_or(0) + one.operations * static_cast<double>(count(one.per));
  if (!dispatch.needs.empty() && count(dispatch.needs) == 0) pass.left_out = fmt::format("there are no {}", dispatch.needs);
  if (dispatch.indirect.empty()) {
    pass.elements = fmt::format("over {}, {}", dispatch.over, count(dispatch.over));
    const auto group = static_cast<std::uint64_t>(dispatch.group);
    const std::uint64_t launched = (count(dispatch.over) + group - 1) / group;
    groups = static_cast<double>(launched);
  } else {
    pass.elements = fmt::format("over {:.1f} groups of {} on average", groups.value_or(0), dispatch.group);
  }
  pass.groups = groups;
}

ProfiledPass describe(const Plan& plan, const graph::Run& run, const GroupCounts& groups) {
  const graph::PlannedStage& stage = plan.stages[static_cast<std::size_t>(run.stage)];
  const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
  ProfiledPass pass{stage.label, stage.spec.doc, stage.spec.equation, work_name(work), "", {}, {}};
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) {
    describe(plan, *dispatch, groups.of(run), pass);
  } else if (const auto* draw = std::get_if<graph::Draw>(&work)) {
    const std::uint64_t instances = graph::element_count(draw->instances, plan.environment).value_or(0);
    pass.elements = fmt::format("{} times {} vertices", instances, draw->vertices);
    if (instances == 0 && !draw->clear) pass.left_out = fmt::format("there are no {}", draw->instances);
  } else {
    pass.host = true;
    pass.elements = "on the processor";
  }
  if (pass.left_out.empty()) pass.traffic = traffic_of(plan, run, groups);
  return pass;
}

class Run {
 public:
  Run(const Loaded& loaded, gpu::Device& device)
      : device_(device),
        execution_(device, loaded.plan, loaded.registry, {shader_folders(), false, false, program_cache_folder()}),
        time_(loaded.problem->scene.time) {
    execution_.setup();
    needs_frames_ =
        std::ranges::any_of(loaded.plan.stages, [](const graph::PlannedStage& stage) { return !stage.spec.resizes.empty(); });
    frame_if_due();
  }

  // The seconds of so many steps.
  double steps(std::uint64_t count, bool timed) {
    execution_.time_passes(timed);
    device_.finish();
    double seconds = 0;
    for (std::uint64_t i = 0; i < count;) {
      const auto start = std::chrono::steady_clock::now();
      do {
        set_time_step();
        execution_.step();
        if (timed) keep(execution_.take_times(false));
      } while (++i < count && !is_frame_due());
      device_.finish();
      seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (timed) keep(execution_.take_times(true));
      execution_.time_passes(false);
      frame_if_due();
      execution_.time_passes(timed);
    }
    return seconds;
  }

  // One more step, untimed.
  void count_groups() {
    execution_.time_passes(false);
    set_time_step();
    groups_.add(execution_.plan(), execution_.step_counting_groups());
  }

  [[nodiscard]] execution::Execution& execution() { return execution_; }
  [[nodiscard]] const GroupCounts& groups() const { return groups_; }
  [[nodiscard]] const std::vector<execution::PassTime>& times() const { return times_; }

 private:
  // Frames are not timed. They are run only where they change how much there is to do: by emitters and sinks.
  [[nodiscard]] bool is_frame_due() {
    const graph::Clock& clock = execution_.clock();
    return needs_frames_ && clock.time >= static_cast<double>(clock.frame) / time_.fps;
  }
  void frame_if_due() {
    if (is_frame_due()) execution_.frame();
  }
  void set_time_step() { execution_.clock().dt = time_.dt.value_or(1.0 / time_.fps); }
  void keep(const std::vector<execution::PassTime>& times) { times_.insert(times_.end(), times.begin(), times.end()); }

  gpu::Device& device_;
  execution::Execution execution_;
  scene::Time time_;
  bool needs_frames_ = false;
  std::vector<execution::PassTime> times_;
  GroupCounts groups_;
};

}  // namespace

Profile run_profile(const Loaded& loaded, gpu::Device& device, const ProfileRequest& request) {
  Profile profile;
  profile.pipeline = loaded.pipeline.name;
  profile.scene = loaded.problem->scene.name.empty() ? loaded.scene_file : loaded.problem->scene.name;
  profile.device = device.info().name;
  profile.clock = device.info().software ? "the processor's clock, each pass waited for: this software renderer's timestamps say "
                                           "nothing of draws"
                                         : "the device's timestamps";
  profile.steps = request.steps;
  profile.units = device.info().software ? static_cast<int>(std::thread::hardware_concurrency()) : 0;
  profile.speed = measure_speed(device);

  Run run(loaded, device);
  run.steps(request.warm_up, false);
  // With and without in turn, in short blocks, so that what else the machine does weighs on both alike; every second time the other
  // way round.
  const std::uint64_t block = request.cost ? std::clamp<std::uint64_t>(request.steps / 20, 1, 10) : 10;
  std::vector<double> ratios;
  double wall = 0;
  for (std::uint64_t done = 0; done < request.steps;) {
    const std::uint64_t count = std::min(block, request.steps - done);
    const bool untimed_first = ratios.size() % 2 == 0;
    double without = request.cost && untimed_first ? run.steps(count, false) : 0;
    const double with = run.steps(count, true);
    if (request.cost && !untimed_first) without = run.steps(count, false);
    if (request.cost) ratios.push_back(with / without);
    wall += with;
    done += count;
    run.count_groups();
  }
  run.execution().check_faults();
  std::vector<const graph::Run*> planned;
  collect(run.execution().plan().step, planned);
  std::map<std::pair<int, int>, std::size_t> rows;
  for (const graph::Run* one : planned)
    if (rows.emplace(std::pair{one->stage, one->work}, profile.passes.size()).second)
      profile.passes.push_back(describe(run.execution().plan(), *one, run.groups()));
  profile.wall = wall / static_cast<double>(request.steps);
  if (request.cost)
    profile.cost = Profile::Cost{median(ratios) - 1, quantile(ratios, 0.25) - 1, quantile(ratios, 0.75) - 1, ratios.size()};

  std::map<std::uint64_t, std::uint64_t> numbers;  // of steps: those between, untimed, do not count
  std::vector<execution::PassTime> times = run.times();
  std::ranges::stable_sort(times, {}, &execution::PassTime::start);
  for (const execution::PassTime& time : times) {
    const auto row = rows.find({time.stage, time.work});
    if (row == rows.end() || !profile.passes[row->second].left_out.empty()) continue;
    profile.passes[row->second].seconds.push_back(time.seconds);
    const std::uint64_t step = numbers.emplace(time.step, numbers.size()).first->second;
    profile.launches.push_back({row->second, step, time.start, time.seconds});
  }
  const double first = profile.launches.empty() ? 0 : profile.launches.front().start;
  for (ProfiledLaunch& launch : profile.launches) launch.start -= first;
  return profile;
}

}  // namespace firn::app
