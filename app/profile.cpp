#include "app/profile.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <stdexcept>

#include "app/choice.h"
#include "app/device_profile.h"
#include "app/files.h"
#include "app/verbs.h"

namespace firn::app {
namespace {

struct ProfileOptions {
  Inputs inputs;
  ProfileRequest request;
  std::string device = "auto", format = "table", output;
};

std::string report(const Profile& profile, const std::string& format) {
  if (format == "json") return as_json(profile).dump(2) + "\n";
  if (format == "trace") return as_trace(profile).dump() + "\n";
  if (format == "html") return as_page(profile);
  return as_table(profile);
}

int profile(const ProfileOptions& options) {
  Loaded loaded = load(options.inputs, "");
  print(loaded.diagnostics);
  if (loaded.plan.step.empty()) {
    config::Diagnostics diagnostics;
    diagnostics.error({loaded.pipeline_file, 0, 0}, "nothing to time: it has no stages in 'step'");
    config::throw_if_errors(diagnostics);
  }
  // Before anything is timed, which may take long.
  if (!options.output.empty() && !std::ofstream(options.output, std::ios::app))
    throw std::runtime_error(fmt::format("cannot write {}", options.output));
  const std::unique_ptr<gpu::Device> device = gpu::Device::open(options.device);
  spdlog::info("measuring the device, then timing {} steps after {}", options.request.steps, options.request.warm_up);
  plan_for(loaded, options.inputs, profile_of(*device));
  const Profile profile = run_profile(loaded, *device, options.request);
  const std::string text = report(profile, options.format);
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_file(options.output, text);
    spdlog::info("{} in {}", options.format, options.output);
  }
  if (options.format != "table") spdlog::info("times by {}", profile.clock);
  return Status::done;
}

}  // namespace

void add_profile(CLI::App& program, Action& action) {
  const auto options = std::make_shared<ProfileOptions>();
  CLI::App* verb = program.add_subcommand("profile", "Time every pass of a step");
  add_inputs(*verb, options->inputs);
  verb->add_option("--steps", options->request.steps, "Steps to time")->check(at_least(1))->capture_default_str();
  verb->add_option("--warm-up", options->request.warm_up, "Steps before them")->check(at_least(0))->capture_default_str();
  verb->add_flag("--cost", options->request.cost, "Also run as many steps untimed, in turn, and tell what the timing costs");
  verb->add_option("--format", options->format, "table; json; trace: Chrome trace events; html: a page that needs nothing else")
      ->check(one_of({"table", "json", "trace", "html"}))
      ->capture_default_str();
  verb->add_option("--out", options->output, "File for it (default: standard output)");
  verb->add_option("--device", options->device, "As for run")->capture_default_str();
  verb->callback([&action, options] { action = [options] { return profile(*options); }; });
}

}  // namespace firn::app
