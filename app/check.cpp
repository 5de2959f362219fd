#include <fmt/format.h>

#include "app/load.h"
#include "app/verbs.h"

namespace firn::app {

void add_check(CLI::App& program, Action& action) {
  const auto inputs = std::make_shared<Inputs>();
  CLI::App* verb = program.add_subcommand("check", "Every error and warning of a pipeline and its scene; nothing is run");
  add_inputs(*verb, *inputs);
  verb->callback([&action, inputs] {
    action = [inputs] {
      const Loaded loaded = load(*inputs, "");
      print(loaded.diagnostics);
      std::size_t work = 0;
      for (const graph::PlannedStage& stage : loaded.plan.stages) work += stage.spec.work.size();
      fmt::print("{}: {} stages, {} kernels and host calls, {} buffers, {:.1f} MiB on the device; {} {}\n", loaded.pipeline_file,
                 loaded.plan.stages.size(), work, loaded.plan.buffers.size(), static_cast<double>(loaded.plan.bytes) / (1 << 20),
                 loaded.diagnostics.all().size(), loaded.diagnostics.all().size() == 1 ? "warning" : "warnings");
      return static_cast<int>(Status::done);
    };
  });
}

}  // namespace firn::app
