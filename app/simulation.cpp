#include "app/simulation.h"

#include <csignal>

namespace firn::app {

std::atomic<bool> interrupted_by_user{false};

void watch_signals() {
  const auto handle = [](int signal) {
    interrupted_by_user = true;
    std::signal(signal, SIG_DFL);
  };
  std::signal(SIGINT, handle);
  std::signal(SIGTERM, handle);
}

Ending simulate(execution::Execution& execution, const scene::Time& time, const Until& until, bool check_every_step,
                const std::function<void(const graph::Clock&)>& after_step, Start start) {
  graph::Clock& clock = execution.clock();
  // Times are compared with room for the rounding of many additions.
  constexpr double slack = 1e-9;
  const auto frame_time = [&](std::uint64_t frame) { return static_cast<double>(frame) / time.fps; };
  const auto over = [&] {
    if (until.steps && clock.step >= *until.steps) return true;
    if (until.frames) return clock.frame >= *until.frames;
    return !until.steps && clock.time >= time.end - slack;
  };
  constexpr std::uint64_t steps_between_checks = 64;

  if (start == Start::fresh) {
    execution.setup();
    execution.check_faults();
    if (!until.frames || *until.frames > 0) execution.frame();
    after_step(clock);
  }
  while (!over()) {
    if (interrupted_by_user) return Ending::interrupted;
    // A step of automatic length ends at the next frame at the latest.
    clock.dt = time.dt.value_or(frame_time(clock.frame) - clock.time);
    execution.step();
    if (time.dt) clock.time = static_cast<double>(clock.step) * *time.dt;
    const bool frame_due = clock.time >= frame_time(clock.frame) - slack;
    if (check_every_step || frame_due || clock.step % steps_between_checks == 0) execution.check_faults();
    if (frame_due) execution.frame();
    after_step(clock);
  }
  execution.check_faults();
  return Ending::complete;
}

}  // namespace firn::app
