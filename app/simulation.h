#pragma once

// The loop over steps and frames.

#include <atomic>
#include <functional>
#include <optional>

#include "graph/execution/execution.h"
#include "scene/scene.h"

namespace firn::app {

struct Until {
  std::optional<std::uint64_t> steps, frames;  // none: the scene's end
};

// Set by SIGINT and SIGTERM once watch_signals() was called; a second signal ends the program at once.
extern std::atomic<bool> interrupted_by_user;
void watch_signals();

enum class Ending { complete, interrupted };

enum class Start { fresh, resumed };  // resumed: the execution has the state of a checkpoint, and its clock

// Setup, then steps, with a frame whenever its time has come (frame 0 before the first step). `after_step` is called with the
// clock after the start, and after every step and the frame that came with it. Throws execution::NumbersError as soon as kernels
// report a fault: after every step where that is free, else with every frame.
Ending simulate(execution::Execution& execution, const scene::Time& time, const Until& until, bool check_every_step,
                const std::function<void(const graph::Clock&)>& after_step, Start start = Start::fresh);

}  // namespace firn::app
