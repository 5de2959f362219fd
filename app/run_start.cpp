#include "app/run_start.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/files.h"
#include "app/json_text.h"
#include "app/named_files.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

[[noreturn]] void refuse(const fs::path& file, const std::string& text) {
  config::Diagnostics diagnostics;
  diagnostics.error({shown(file), 0, 0}, text);
  throw config::InputError(diagnostics);
}

// A name that no file system takes is neither.
bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}
bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

// out/<pipeline>-<scene>, so that runs of several pipelines on several scenes do not mix.
fs::path default_output(const Inputs& inputs) {
  std::string name = fs::path(inputs.pipeline).stem().string();
  if (!inputs.scene.empty()) name += "-" + fs::path(inputs.scene).stem().string();
  return fs::path("out") / name;
}

// Relative where it lies below the working folder.
fs::path as_seen_from_here(const fs::path& absolute) {
  const fs::path relative = absolute.lexically_relative(fs::current_path());
  return relative.empty() || relative.begin()->string() == ".." ? absolute : relative;
}

// What the command line says goes before what is kept; changes of the scene and of stages, and exports, add up.
void follow(const RunOptions& given, RunOptions& kept) {
  const auto add = [&](std::vector<std::string> Inputs::*words) {
    for (const std::string& word : given.inputs.*words)
      if (std::ranges::find(kept.inputs.*words, word) == (kept.inputs.*words).end()) (kept.inputs.*words).push_back(word);
  };
  kept.inputs.set.insert(kept.inputs.set.end(), given.inputs.set.begin(), given.inputs.set.end());
  add(&Inputs::disable);
  add(&Inputs::replace);
  add(&Inputs::exports);
  const Inputs unsaid;
  if (!given.inputs.pipeline.empty()) kept.inputs.pipeline = given.inputs.pipeline;
  if (!given.inputs.scene.empty()) kept.inputs.scene = given.inputs.scene;
  if (given.inputs.image != unsaid.image) kept.inputs.image = given.inputs.image;
  if (given.inputs.repeats != unsaid.repeats) kept.inputs.repeats = given.inputs.repeats;
  if (!given.inputs.share_memory) kept.inputs.share_memory = false;
  if (given.steps || given.frames) {
    kept.steps = given.steps;
    kept.frames = given.frames;
  }
  if (!given.dumps.empty()) kept.dumps = given.dumps;
  if (given.device != RunOptions{}.device) kept.device = given.device;
  if (given.barriers != RunOptions{}.barriers) kept.barriers = given.barriers;
  if (given.checkpoint_every > 0) kept.checkpoint_every = given.checkpoint_every;
  if (given.keep_checkpoints) kept.keep_checkpoints = given.keep_checkpoints;
  kept.output = given.output;
  kept.force = given.force;
}

RunStart resumed(RunOptions given) {
  RunStart start;
  // `--resume PIPELINE` is meant as `PIPELINE --resume`.
  if (given.inputs.pipeline.empty() && is_file(find_input(*given.resume, "pipelines")))
    given.inputs.pipeline = std::exchange(*given.resume, "");
  fs::path from = *given.resume;
  if (from.empty()) from = !given.output.empty() ? fs::path(given.output) : default_output(given.inputs);
  start.checkpoint = read_checkpoint(from);
  start.options = given;
  if (given.inputs.pipeline.empty()) {
    const fs::path manifest = start.checkpoint->folder / "manifest.json";
    const json& inputs = start.checkpoint->manifest["inputs"];
    start.options = options_from(inputs, manifest.string());
    for (std::string& dump : start.options.dumps)
      if (const auto sign = dump.find('='); sign != std::string::npos)
        dump = dump.substr(0, sign + 1) + (fs::path(inputs.value("started_in", "")) / dump.substr(sign + 1)).string();
    follow(given, start.options);
  }
  const graph::Clock& clock = start.checkpoint->clock;
  const auto refuse_before = [&](const char* word, std::optional<std::uint64_t> end, std::uint64_t reached) {
    if (end && *end < reached)
      refuse(start.checkpoint->folder, fmt::format("is at {} {}, beyond --{} {}; earlier ones lie beside it, if they were kept",
                                                   word, reached, fmt::format("{}s", word), *end));
  };
  refuse_before("step", given.steps, clock.step);
  refuse_before("frame", given.frames, clock.frame);
  const fs::path own = run_of(*start.checkpoint);
  start.output = !given.output.empty() ? fs::path(given.output)
                 : !own.empty()        ? as_seen_from_here(own)
                                       : default_output(start.options.inputs);
  std::error_code error;
  start.claim = fs::equivalent(start.output, own, error) ? Claim::resume : given.force ? Claim::replace : Claim::fresh;
  return start;
}

RunStart repeated(const RunOptions& given) {
  RunStart start;
  const fs::path file = is_folder(given.from) ? fs::path(given.from) / run_manifest : fs::path(given.from);
  constexpr std::uint64_t longest_manifest = 256 << 20;
  try {
    start.repeated = parse_json(read_whole(file, longest_manifest));
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    refuse(file, text.substr(std::min(text.find(": ") + 2, text.size())));
  }
  if (!start.repeated.is_object() || !start.repeated.contains("inputs") || !start.repeated["inputs"].is_object())
    refuse(file, "is no manifest of a run");
  if (!start.repeated.contains("outputs") || !start.repeated["outputs"].is_object() || start.repeated["outputs"].empty())
    refuse(file, "has no hashes of outputs to compare with: that run did not come to its end, or wrote nothing");
  start.options = options_from(start.repeated["inputs"], file.string());
  RunOptions words = given;
  follow(words, start.options);
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  start.output = !given.output.empty() ? fs::path(given.output) : as_seen_from_here(folder.string() + "-repeat");
  start.claim = given.force ? Claim::replace : Claim::fresh;
  // The first run's own files stay as they are.
  if (given.dumps.empty())
    for (std::string& dump : start.options.dumps)
      if (const auto sign = dump.find('='); sign != std::string::npos)
        dump = dump.substr(0, sign + 1) + (start.output / fs::path(dump.substr(sign + 1)).filename()).string();
  return start;
}

}  // namespace

RunStart run_start(RunOptions given) {
  if (given.resume) return resumed(std::move(given));
  if (!given.from.empty()) return repeated(given);
  RunStart start;
  start.output = !given.output.empty() ? fs::path(given.output) : default_output(given.inputs);
  start.claim = given.force ? Claim::replace : Claim::fresh;
  start.options = std::move(given);
  return start;
}

}  // namespace firn::app
