#include "app/try_stage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <set>

#include "app/arrays.h"
#include "app/load.h"
#include "app/neutral.h"
#include "app/one_stage.h"
#include "app/shipped.h"
#include "app/try_sizes.h"
#include "config/nearest.h"
#include "graph/execution/kernels.h"
#include "graph/glsl.h"

namespace firn::app {
namespace {

using graph::Access;
using graph::PlannedStage;
using graph::Port;

bool is_picture(const Port& port) {
  return graph::is_texel(port.type) || port.usage == graph::Usage::framebuffer || port.usage == graph::Usage::image;
}

// Whether the first piece of work that touches a port finds what was there before.
bool content_counts(const PlannedStage& stage, std::size_t port) {
  for (const graph::Work& work : stage.spec.work)
    for (const graph::UsedPort& used : graph::used_ports(stage, work))
      if (static_cast<std::size_t>(used.port) == port) return graph::reads(used.access) || used.access == Access::accumulate;
  return false;
}

class Preparation {
 public:
  explicit Preparation(const TryOptions& options) : options_(options), place_{"try " + options.stage, 0, 0} {}

  Trial run() {
    changes_ = read_overrides(options_.set, diagnostics());
    read_scene();
    trial_.registry = stages::all_stages(problem_);
    stage_ = find_stage(options_.stage, "try", trial_.registry);
    read_words();
    // Which ports and work there are depends on the parameters: a first plan tells, in which every domain has one element.
    const graph::Environment known = known_environment();
    const auto wanted = [this](const Port& port) { return asked_for(port); };
    const graph::PipelineSpec pipeline = pipeline_of(stage_, stage_parameters(changes_, stage_.name), wanted);
    graph::Environment sketched = sketch_environment(stage_, known, wanted);
    if (problem_ != nullptr) sketched.choices = stages::environment(*problem_).choices;
    config::Diagnostics of_parameters;
    const graph::Plan sketch = graph::compile(pipeline, trial_.registry, sketched, of_parameters);
    for (const config::Diagnostic& one : of_parameters.all())
      if (one.severity == config::Severity::error) diagnostics().error(one.place, one.text);
    if (sketch.stages.empty()) config::throw_if_errors(diagnostics());
    check_ports(sketch.stages.front());
    require_ports(sketch.stages.front());
    // What is missing besides is told only where it does not follow from what is missing already.
    graph::Environment environment = own_environment(known);
    if (inputs_complete_) {
      size_domains(sketch.stages.front(), arrays_, options_.sizes, environment, trial_.notes, diagnostics());
      set_constants(sketch.stages.front().spec, arrays_, options_.constants, known, environment, trial_.notes, diagnostics());
    }
    const bool complete = !diagnostics().has_errors();
    if (complete) trial_.plan = graph::compile(pipeline, trial_.registry, environment, diagnostics());
    config::throw_if_errors(diagnostics());
    fill(trial_.plan.stages.front());
    choose_time_step();
    return std::move(trial_);
  }

 private:
  config::Diagnostics& diagnostics() { return trial_.diagnostics; }

  void read_scene() {
    const bool of_scene = std::ranges::any_of(changes_, [](const auto& change) { return change.path.front() == "scene"; });
    if (options_.scene.empty()) {
      if (of_scene) diagnostics().error(place_, "scene.<key>=<value> needs a scene: --scene SCENE");
      return;
    }
    config::Node node;
    const std::string file = find_input(options_.scene, "pipelines/scenes");
    if (std::filesystem::exists(file))
      problem_ = load_problem(file, changes_, {}, "", node, diagnostics());
    else
      diagnostics().error({options_.scene, 0, 0}, "there is no such file" + suggest_file(options_.scene, shipped_scenes()));
    config::throw_if_errors(diagnostics());
  }

  void read_words() {
    const std::vector<NamedFile> in = read_named_files(options_.in, "--in", "PORT", diagnostics());
    for (const NamedFile& input : in) {
      try {
        GivenArray given{input.file, scene::read_npy(input.file), input.place};
        if (!arrays_.emplace(input.name, std::move(given)).second)
          diagnostics().error(input.place, fmt::format("'{}' is given twice", input.name));
      } catch (const std::runtime_error& error) {
        diagnostics().error(input.place, error.what());
        unreadable_.insert(input.name);
        inputs_complete_ = false;
      }
    }
    trial_.outputs = read_named_files(options_.out, "--out", "PORT", diagnostics());
    check_folders(trial_.outputs, diagnostics());
  }

  [[nodiscard]] bool asked_for_input(const Port& port) const {
    return arrays_.contains(port.name) || unreadable_.contains(port.name);
  }
  // Optional ports are bound where they are given or asked for.
  [[nodiscard]] bool asked_for(const Port& port) const {
    return asked_for_input(port) || std::ranges::find(trial_.outputs, port.name, &NamedFile::name) != trial_.outputs.end();
  }

  [[nodiscard]] graph::Environment own_environment(const graph::Environment& known) const {
    graph::Environment environment;
    if (problem_ != nullptr)
      environment = stages::environment(*problem_);
    else
      environment.choices = known.choices;
    for (const Port& port : stage_.spec->ports)
      if (!port.optional || asked_for(port)) environment.provided.insert(port.name);
    return environment;
  }

  // Names and types of what is given and asked for.
  void check_ports(const PlannedStage& stage) {
    std::vector<std::string> readable, writable;
    for (std::size_t p = 0; p < stage.spec.ports.size(); ++p) {
      const Port& port = stage.spec.ports[p];
      if (!is_picture(port)) readable.push_back(port.name);
      if (!graph::is_texel(port.type) && graph::writes(port.access)) writable.push_back(port.name);
    }
    const auto find = [&](const std::string& name, const config::Place& place, const std::vector<std::string>& valid,
                          const char* what) {
      const auto port = std::ranges::find(stage.spec.ports, name, &Port::name);
      if (std::ranges::find(valid, name) != valid.end()) return &*port;
      std::string why = fmt::format("{} has no {} '{}'{}", stage.spec.name, what, name, config::suggestion(name, valid));
      if (port != stage.spec.ports.end())
        why = is_picture(*port) ? fmt::format("'{}' is a picture, not an array", name)
                                : fmt::format("{} only reads '{}'", stage.spec.name, name);
      else if (std::ranges::find(stage_.spec->ports, name, &Port::name) != stage_.spec->ports.end())
        why = fmt::format("{} has the port '{}' only with other parameters", stage.spec.name, name);
      diagnostics().error(place, why);
      return static_cast<const Port*>(nullptr);
    };
    std::vector<std::string> unknown;
    for (const auto& [name, given] : arrays_) {
      const Port* port = find(name, given.place, readable, "port");
      inputs_complete_ &= port != nullptr;
      if (port == nullptr)
        unknown.push_back(name);
      else
        check_values(*port, given);
    }
    for (const std::string& name : unknown) arrays_.erase(name);
    for (const NamedFile& output : trial_.outputs) find(output.name, output.place, writable, "output");
    for (const graph::Work& work : stage.spec.work)
      if (std::holds_alternative<graph::HostWork>(work) && problem_ == nullptr) {
        diagnostics().error(place_, fmt::format("{} works on a scene: --scene SCENE", stage.spec.name));
        inputs_complete_ = false;
        break;
      }
  }

  void check_values(const Port& port, const GivenArray& given) {
    const scene::NpyKind wanted = array_kind(port.type), kind = given.array.kind;
    if (wanted == scene::NpyKind::float32) return;  // whole numbers are numbers
    if (kind == scene::NpyKind::float32 || kind == scene::NpyKind::float64) {
      diagnostics().error(given.place,
                          fmt::format("{} holds {}; {} wants {} (in NumPy: array.astype(numpy.{}))", given.file,
                                      scene::to_string(kind), port.name, scene::to_string(wanted), scene::to_string(wanted)));
      return;
    }
    const bool natural = wanted == scene::NpyKind::uint32;
    const double least = natural ? 0 : std::numeric_limits<std::int32_t>::min();
    const double most = natural ? std::numeric_limits<std::uint32_t>::max() : std::numeric_limits<std::int32_t>::max();
    const auto bad = std::ranges::find_if(given.array.values, [&](double value) { return value < least || value > most; });
    if (bad != given.array.values.end())
      diagnostics().error(given.place,
                          fmt::format("{} holds {:.0f}; {} wants {}", given.file, *bad, port.name, scene::to_string(wanted)));
  }

  // Ports that something must be given for.
  void require_ports(const PlannedStage& stage) {
    for (std::size_t p = 0; p < stage.spec.ports.size(); ++p) {
      const Port& port = stage.spec.ports[p];
      if (stage.buffers[p] < 0 || asked_for_input(port) || !content_counts(stage, p)) continue;
      if (is_picture(port))
        diagnostics().error(place_,
                            fmt::format("{} goes on from the picture '{}', which no array can be", stage.spec.name, port.name));
      else if (!neutral_value(port))
        diagnostics().error(place_, fmt::format("{} needs --in {}=FILE.npy, shape {}, {}: {}", stage.spec.name, port.name,
                                                expected_shape(port), scene::to_string(array_kind(port.type)), port.doc));
      else
        continue;
      inputs_complete_ = false;
    }
  }

  void fill(const PlannedStage& stage) {
    std::vector<std::string> zeros;
    for (std::size_t p = 0; p < stage.spec.ports.size(); ++p) {
      const Port& port = stage.spec.ports[p];
      if (stage.buffers[p] < 0) continue;
      const graph::PlannedBuffer& buffer = trial_.plan.buffers[static_cast<std::size_t>(stage.buffers[p])];
      if (const auto given = arrays_.find(port.name); given != arrays_.end()) {
        trial_.contents[buffer.name] = packed_values(port.type, given->second.array.values);
        continue;
      }
      if (!content_counts(stage, p) || buffer.count == 0) continue;
      const Neutral neutral = *neutral_value(port);
      std::vector<double> values(buffer.count * static_cast<std::uint64_t>(graph::components(port.type)));
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = neutral.element[i % neutral.element.size()];
      trial_.contents[buffer.name] = packed_values(port.type, values);
      if (neutral.meaning.empty())
        zeros.push_back(port.name);
      else
        trial_.notes.push_back(fmt::format("{} not given: {} ({})", port.name, fmt::join(neutral.element, ", "), neutral.meaning));
    }
    if (!zeros.empty()) trial_.notes.push_back(fmt::format("not given, so 0: {}", fmt::join(zeros, ", ")));
  }

  void choose_time_step() {
    if (options_.dt)
      trial_.dt = *options_.dt;
    else if (problem_ != nullptr)
      trial_.dt = problem_->scene.time.dt.value_or(1.0 / problem_->scene.time.fps);
    else if (uses_time_step())
      trial_.notes.push_back("no --dt: a step of 0 s");
  }

  // Whether a kernel's own text names dt.
  [[nodiscard]] bool uses_time_step() const {
    const auto mentions = [](const std::string& text) {
      std::size_t count = 0;
      for (auto at = text.find("dt"); at != std::string::npos; at = text.find("dt", at + 2)) {
        const auto in_word = [&](std::size_t i) { return i < text.size() && (std::isalnum(text[i]) != 0 || text[i] == '_'); };
        count += in_word(at - 1) || in_word(at + 2) ? 0 : 1;
      }
      return count;
    };
    const std::vector<graph::Work>& work = trial_.plan.stages.front().spec.work;
    const std::vector<std::filesystem::path> folders = shader_folders();
    for (int w = 0; w < static_cast<int>(work.size()); ++w)
      if (const auto* dispatch = std::get_if<graph::Dispatch>(&work[static_cast<std::size_t>(w)])) {
        const gpu::ShaderSource source =
            execution::kernel_source(trial_.plan, 0, w, dispatch->kernel, gpu::ShaderKind::compute, {}, folders);
        if (mentions(source.text) > mentions(graph::compute_prelude(trial_.plan, 0, w, {}))) return true;
      }
    return false;
  }

  const TryOptions& options_;
  config::Place place_;
  Trial trial_;
  std::vector<config::Override> changes_;
  std::shared_ptr<const stages::Problem> problem_;
  OneStage stage_;
  GivenArrays arrays_;
  std::set<std::string> unreadable_;  // ports whose arrays are told to be wrong
  bool inputs_complete_ = true;
};

}  // namespace

Trial prepare_trial(const TryOptions& options) { return Preparation(options).run(); }

}  // namespace firn::app
