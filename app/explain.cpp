#include "app/explain.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <filesystem>

#include "app/choice.h"
#include "app/device_profile.h"
#include "app/files.h"
#include "app/load.h"
#include "app/verbs.h"
#include "stages/process.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

struct ExplainOptions {
  Inputs inputs;
  std::string format = "text", output, device = "software";
};

// A new folder below the system's temporary one, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "firn-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(fmt::format("cannot make a folder such as {}", name));
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  fs::path path;
};

std::string drawn(const std::string& dot) {
  const fs::path graphviz = stages::find_program("dot");
  if (graphviz.empty())
    throw std::runtime_error(
        "svg is drawn by Graphviz, whose program 'dot' is not installed (on Debian: apt install graphviz); '--format dot' writes "
        "what it would draw");
  const TemporaryFolder folder;
  const fs::path source = folder.path / "plan.dot", picture = folder.path / "plan.svg", errors = folder.path / "errors";
  write_file(source, dot);
  stages::Process process(graphviz, {"-Tsvg", "-o", picture.string(), source.string()}, "", errors);
  if (process.finish() != 0) throw std::runtime_error(fmt::format("dot could not draw the plan: {}", read_whole(errors)));
  return read_whole(picture);
}

int explain(const ExplainOptions& options) {
  Loaded loaded = load(options.inputs, "");
  print(loaded.diagnostics);
  FormsOfPlan forms{profile_for(options.device), "", {}};
  forms.reason = plan_for(loaded, options.inputs, forms.device);
  forms.choices = graph::automatic_choices(loaded.pipeline, loaded.registry, loaded.plan.environment);
  std::string result;
  if (options.format == "json") {
    nlohmann::json all = explain_as_json(loaded.plan);
    all["forms"] = forms_as_json(forms);
    result = all.dump(2) + "\n";
  } else if (options.format == "text") {
    result = explain_as_text(loaded.plan, loaded.pipeline.doc) + forms_as_text(forms);
  } else {
    result = explain_as_dot(loaded.plan, loaded.pipeline.doc);
  }
  if (options.format == "svg") result = drawn(result);
  if (options.output.empty())
    fmt::print("{}", result);
  else
    write_file(options.output, result);
  return Status::done;
}

}  // namespace

std::string work_name(const graph::Work& work) {
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) {
    const fs::path kernel = dispatch->kernel;
    return kernel.is_absolute() ? kernel.filename().string() : dispatch->kernel;
  }
  if (const auto* draw = std::get_if<graph::Draw>(&work)) return draw->name;
  return "host";
}

void add_explain(CLI::App& program, Action& action) {
  const auto options = std::make_shared<ExplainOptions>();
  CLI::App* verb = program.add_subcommand("explain", "The plan of a pipeline: order, bindings, every barrier and why, memory");
  add_inputs(*verb, options->inputs);
  verb->add_option("--format", options->format, "text; json; dot, for Graphviz; svg, a picture that Graphviz draws")
      ->check(one_of({"text", "json", "dot", "svg"}))
      ->capture_default_str();
  verb->add_option(
          "--device", options->device,
          "What to plan for: software, hardware, subgroups (hardware that has them) are assumed; auto, a number or a part of a "
          "name is opened and asked, as for run")
      ->capture_default_str();
  verb->add_option("--out", options->output, "File for it (default: stdout)");
  verb->callback([&action, options] { action = [options] { return explain(*options); }; });
}

}  // namespace firn::app
