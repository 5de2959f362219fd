#include "app/schema.h"

#include <fmt/format.h>

#include "app/choice.h"
#include "app/files.h"
#include "app/verbs.h"
#include "stages/register.h"

namespace firn::app {
namespace {

int schema(const std::string& kind, const std::string& output) {
  const nlohmann::json schema = kind == "scene" ? scene_schema() : pipeline_schema(stages::all_stages(nullptr));
  const std::string text = schema.dump(1) + "\n";
  if (output.empty()) {
    fmt::print("{}", text);
    return Status::done;
  }
  write_file(output, text);
  return Status::done;
}

}  // namespace

void add_schema(CLI::App& program, Action& action) {
  struct Options {
    std::string kind, output;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* verb = program.add_subcommand("schema", "JSON Schema of pipelines or scenes, for editors");
  verb->add_option("KIND", options->kind, "pipeline or scene")->required()->check(one_of({"pipeline", "scene"}));
  verb->add_option("--out", options->output, "File for it (default: stdout)");
  verb->callback([&action, options] { action = [options] { return schema(options->kind, options->output); }; });
}

}  // namespace firn::app
