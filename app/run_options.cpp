#include "app/run_options.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "app/files.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// As find_input() finds it, but from where the run was started: another file of that name may lie here.
std::string found(const std::string& name, const std::string& started_in) {
  std::error_code error;  // a name that no file system takes is no file
  if (name.empty() || fs::equivalent(started_in, ".", error)) return name;
  for (const char* ending : {"", ".yaml"}) {
    const fs::path there = fs::path(started_in) / (name + ending);
    if (fs::is_regular_file(there, error)) return there.string();
  }
  return name;
}

// json would turn -1 and 1e300 into some whole number or other.
std::uint64_t whole(const json& values, const char* key) {
  const json& value = values.at(key);
  if (!value.is_number_unsigned()) throw std::runtime_error(fmt::format("\"{}\" must be a whole number from 0", key));
  return value.get<std::uint64_t>();
}

}  // namespace

json to_json(const RunOptions& options) {
  const Inputs& inputs = options.inputs;
  json result{{"pipeline", inputs.pipeline},
              {"scene", inputs.scene},
              {"set", inputs.set},
              {"disable", inputs.disable},
              {"replace", inputs.replace},
              {"export", inputs.exports},
              {"image", inputs.image},
              {"share_memory", inputs.share_memory},
              {"repeats", inputs.repeats},
              {"device", options.device},
              {"barriers", options.barriers},
              {"dump", options.dumps},
              {"checkpoint_every", options.checkpoint_every},
              {"keep_checkpoints", options.keep_checkpoints.value_or(default_keep)},
              {"started_in", fs::current_path().string()}};
  if (options.steps) result["steps"] = *options.steps;
  if (options.frames) result["frames"] = *options.frames;
  return result;
}

RunOptions options_from(const json& values, const std::string& file) {
  RunOptions options;
  try {
    Inputs& inputs = options.inputs;
    const std::string started_in = values.at("started_in");
    inputs.pipeline = found(values.at("pipeline"), started_in);
    inputs.scene = found(values.at("scene"), started_in);
    values.at("set").get_to(inputs.set);
    values.at("disable").get_to(inputs.disable);
    values.at("replace").get_to(inputs.replace);
    if (values.contains("export")) values.at("export").get_to(inputs.exports);  // runs of versions before have none
    values.at("image").get_to(inputs.image);
    values.at("share_memory").get_to(inputs.share_memory);
    values.at("repeats").get_to(inputs.repeats);
    values.at("device").get_to(options.device);
    values.at("barriers").get_to(options.barriers);
    values.at("dump").get_to(options.dumps);
    options.checkpoint_every = whole(values, "checkpoint_every");
    options.keep_checkpoints = whole(values, "keep_checkpoints");
    if (values.contains("steps")) options.steps = whole(values, "steps");
    if (values.contains("frames")) options.frames = whole(values, "frames");
  } catch (const std::exception& error) {
    config::Diagnostics diagnostics;
    diagnostics.error({file, 0, 0}, std::string("does not tell what the run was asked for: ") + error.what());
    throw config::InputError(diagnostics);
  }
  return options;
}

}  // namespace firn::app
