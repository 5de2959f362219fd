#include "graph/execution/programs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>
#include <string>
#include <thread>

#include "graph/execution/stage_file_errors.h"

namespace firn::execution {
namespace {

struct Task {
  int stage = 0, work = 0;
  gpu::ProgramSource source;
};

std::vector<Task> tasks_of(const graph::Plan& plan, const gpu::Device& device,
                           std::span<const std::filesystem::path> shader_folders) {
  std::vector<Task> tasks;
  for (int s = 0; s < static_cast<int>(plan.stages.size()); ++s)
    for (int w = 0; w < static_cast<int>(plan.stages[static_cast<std::size_t>(s)].spec.work.size()); ++w) {
      Task task{s, w, program_source(plan, s, w, traits_of(device), shader_folders)};
      if (!task.source.shaders.empty()) tasks.push_back(std::move(task));
    }
  return tasks;
}

// The programs of stages that are files once more, one by one: what is wrong with them is their authors' to mend.
void tell_stage_files(const graph::Plan& plan, const std::vector<Task>& tasks) {
  config::Diagnostics diagnostics;
  std::set<std::string> told;  // a file may be there as several stages
  for (const Task& task : tasks) {
    const graph::Work& work = plan.stages[static_cast<std::size_t>(task.stage)].spec.work[static_cast<std::size_t>(task.work)];
    const auto* dispatch = std::get_if<graph::Dispatch>(&work);
    if (dispatch == nullptr || !is_stage_file(dispatch->kernel)) continue;
    try {
      gpu::compile_programs(std::span(&task.source, 1), nullptr);
    } catch (const gpu::ShaderError& error) {
      const gpu::ShaderSource& source = task.source.shaders.front().second;
      const config::Diagnostics errors = stage_file_errors(error.what(), source, dispatch->kernel);
      for (const config::Diagnostic& one : errors.all())
        if (one.severity == config::Severity::error && told.insert(config::to_string(one)).second)
          diagnostics.error(one.place, one.text);
    }
  }
  config::throw_if_errors(diagnostics);
}

class Maker {
 public:
  Maker(std::vector<std::vector<Kernel>>& kernels, gpu::Device& device, const gpu::ProgramCache* cache,
        const std::function<void(int, int)>& rehearse)
      : kernels_(kernels), device_(device), cache_(cache), rehearse_(rehearse) {}

  // Of those that the cache has not got.
  void compile(const std::vector<Task>& tasks) {
    if (device_.info().software)
      compile_on_threads(tasks);
    else
      compile_at_once(tasks);
  }

  [[nodiscard]] bool cached(const Task& task) {
    if (cache_ == nullptr) return false;
    std::optional<gpu::Program> program = gpu::cached_program(task.source, *cache_);
    if (program) kernel(task).program = std::move(*program);
    return program.has_value();
  }

 private:
  [[nodiscard]] Kernel& kernel(const Task& task) {
    return kernels_[static_cast<std::size_t>(task.stage)][static_cast<std::size_t>(task.work)];
  }

  // Drivers of hardware have threads of their own.
  void compile_at_once(const std::vector<Task>& tasks) {
    std::vector<gpu::ProgramSource> sources;
    for (const Task& task : tasks) sources.push_back(task.source);
    std::vector<gpu::Program> programs = gpu::compile_programs(sources, cache_);
    for (std::size_t i = 0; i < tasks.size(); ++i) kernel(tasks[i]).program = std::move(programs[i]);
  }

  // Mesa's software renderer compiles when and where it is told to, and makes machine code at the first dispatch or draw, per
  // context; what another context has made it finds in its own cache on disk. Without that (it hands out no programs then) only the
  // first half can be shared out.
  void compile_on_threads(const std::vector<Task>& tasks) {
    const bool machine_code = device_.info().program_binary_formats > 0;
    std::vector<std::string> errors(tasks.size());
    device_.share_out(tasks.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
      try {
        kernel(tasks[i]).program = std::move(gpu::compile_programs(std::span(&tasks[i].source, 1), cache_).front());
        if (machine_code) rehearse_(tasks[i].stage, tasks[i].work);
      } catch (const gpu::ShaderError& error) {
        errors[i] = error.what();
      }
    });
    std::erase(errors, "");
    errors.erase(std::unique(errors.begin(), errors.end()), errors.end());
    if (!errors.empty()) throw gpu::ShaderError(fmt::format("{}", fmt::join(errors, "\n")));
  }

  std::vector<std::vector<Kernel>>& kernels_;
  gpu::Device& device_;
  const gpu::ProgramCache* cache_;
  const std::function<void(int, int)>& rehearse_;
};

}  // namespace

void make_programs(const graph::Plan& plan, std::vector<std::vector<Kernel>>& kernels, gpu::Device& device,
                   std::span<const std::filesystem::path> shader_folders, const gpu::ProgramCache* cache,
                   const std::function<void(int stage, int work)>& rehearse) {
  std::vector<Task> tasks = tasks_of(plan, device, shader_folders);
  const std::size_t all = tasks.size();
  Maker maker(kernels, device, cache, rehearse);
  std::erase_if(tasks, [&](const Task& task) { return maker.cached(task); });
  spdlog::debug("{} of {} programs are in the cache", all - tasks.size(), all);
  if (tasks.empty()) return;
  try {
    maker.compile(tasks);
  } catch (const gpu::ShaderError&) {
    tell_stage_files(plan, tasks);
    throw;
  }
  if (cache != nullptr) cache->trim();
}

}  // namespace firn::execution
