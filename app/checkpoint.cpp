#include "app/checkpoint.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/arrays.h"
#include "app/checkpoint_files.h"
#include "app/files.h"
#include "app/json_text.h"
#include "app/packed_array.h"
#include "app/sha256.h"
#include "graph/carried.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* format_name = "firn checkpoint";
constexpr int format_version = 1;
constexpr std::uint64_t longest_manifest = 64 << 20;

[[noreturn]] void refuse(const fs::path& file, const std::string& text) {
  config::Diagnostics diagnostics;
  diagnostics.error({shown(file), 0, 0}, text);
  throw config::InputError(diagnostics);
}

// What a run carries from step to step, and what is wanted at its end.
std::vector<int> kept(const graph::Plan& plan) {
  std::vector<int> buffers = graph::carried(plan);
  for (int b = 0; b < static_cast<int>(plan.buffers.size()); ++b)
    if (const graph::PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(b)];
        plan.environment.provided.contains(buffer.name) && std::ranges::find(buffers, b) == buffers.end())
      buffers.push_back(b);
  std::erase_if(buffers, [&](int b) { return plan.buffers[static_cast<std::size_t>(b)].count == 0; });
  return buffers;
}

// Domains whose elements come and go.
std::set<std::string> resized(const graph::Plan& plan) {
  std::set<std::string> domains;
  for (const graph::PlannedStage& stage : plan.stages)
    if (const std::string& domain = stage.spec.resizes; plan.environment.domains.contains(domain)) domains.insert(domain);
  return domains;
}

void remove_older(const fs::path& run, std::size_t keep) {
  const std::vector<fs::path> all = checkpoints_of(run);
  for (std::size_t i = 0; i + keep < all.size(); ++i) fs::remove_all(all[i]);
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(run / "checkpoints", error))
    if (entry.path().extension() == ".part") fs::remove_all(entry.path(), error);  // of a run that was killed
}

void write_files(const fs::path& folder, const execution::Execution& execution, const graph::Clock& clock, json about) {
  const graph::Plan& plan = execution.plan();
  json buffers = json::array();
  std::map<std::string, std::string> hashes;
  const auto add = [&](const std::string& name, std::string_view content) {
    write_file(folder / name, content);
    hashes[name] = sha256(content);
  };
  for (const int b : kept(plan)) {
    const graph::PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(b)];
    const PackedArray array = pack(plan, buffer, execution.read(buffer.name));
    add(array_file(buffer.name), array.file);
    buffers.push_back({{"name", buffer.name},
                       {"file", array_file(buffer.name)},
                       {"type", graph::name(buffer.type)},
                       {"domain", buffer.domain},
                       {"count", buffer.count},
                       {"unit", buffer.unit},
                       {"not_a_number", array.no_numbers}});
  }
  about["format"] = format_name;
  about["version"] = format_version;
  about["written"] = now_in_utc();
  about["step"] = clock.step;
  about["frame"] = clock.frame;
  about["time"] = clock.time;
  about["dt"] = clock.dt;
  about["sizes"] = json::object();
  for (const std::string& domain : resized(plan)) about["sizes"][domain] = plan.environment.domains.at(domain).count;
  about["buffers"] = buffers;
  add(checkpoint_manifest, about.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  write_file(folder / hash_list, hash_lines(hashes));
}

json read_manifest(const fs::path& file) {
  json manifest = parse_json(read_whole(file, longest_manifest));
  if (manifest.is_discarded() || !manifest.is_object()) refuse(file, "is no JSON object");
  if (manifest.value("format", json()) != format_name)
    refuse(file, fmt::format("is no manifest of a checkpoint: its \"format\" must be \"{}\"", format_name));
  if (const json version = manifest.value("version", json()); version != format_version)
    refuse(file, fmt::format("has format version {}; this program reads version {}", version.dump(), format_version));
  return manifest;
}

graph::Clock read_clock(const fs::path& file, const json& manifest) {
  const auto number = [&](const char* key) {
    const json value = manifest.value(key, json());
    if (!value.is_number() || !std::isfinite(value.get<double>()) || value.get<double>() < 0)
      refuse(file, fmt::format("\"{}\" must be a number from 0", key));
    return value;
  };
  const auto whole = [&](const char* key) {
    const json value = number(key);
    if (!value.is_number_unsigned()) refuse(file, fmt::format("\"{}\" must be a whole number from 0", key));
    return value.get<std::uint64_t>();
  };
  graph::Clock clock;
  clock.dt = number("dt").get<double>();
  clock.time = number("time").get<double>();
  clock.step = whole("step");
  clock.frame = whole("frame");
  return clock;
}

Checkpoint read_one(const fs::path& folder) {
  try {
    verify_files(folder);
    Checkpoint checkpoint{folder, read_manifest(folder / checkpoint_manifest), {}};
    checkpoint.clock = read_clock(folder / checkpoint_manifest, checkpoint.manifest);
    for (const char* key : {"identity", "inputs", "buffers"})
      if (!checkpoint.manifest.contains(key)) refuse(folder / checkpoint_manifest, fmt::format("has no \"{}\"", key));
    if (!checkpoint.manifest["identity"].is_object() || !checkpoint.manifest["inputs"].is_object() ||
        !checkpoint.manifest["buffers"].is_array())
      refuse(folder / checkpoint_manifest, "\"identity\" and \"inputs\" must be objects, \"buffers\" a list");
    return checkpoint;
  } catch (const config::InputError&) {
    throw;
  } catch (const std::exception& error) {
    config::Diagnostics diagnostics;
    const std::string text = error.what();
    const std::size_t colon = text.find(": ");
    diagnostics.error({text.substr(0, colon), 0, 0}, colon == std::string::npos ? text : text.substr(colon + 2));
    throw config::InputError(diagnostics);
  }
}

// What else there is to go on from, best first.
std::string offer(const fs::path& broken) {
  std::vector<fs::path> all = checkpoints_of(broken.parent_path().parent_path());
  std::ranges::reverse(all);
  const std::string name = broken.filename().string();
  std::stable_partition(all.begin(), all.end(), [&](const fs::path& each) { return each.filename().string() < name; });
  for (const fs::path& each : all)
    if (each.filename() != broken.filename()) try {
        read_one(each);
        return fmt::format("; another checkpoint of this run is whole: --resume {}", shown(each));
      } catch (const config::InputError&) {
        continue;
      }
  return "; no other checkpoint of this run is whole";
}

// Where the checkpoint is: `folder` itself, or the newest in it.
fs::path find_checkpoint(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    refuse(folder, error && error != std::errc::no_such_file_or_directory ? "cannot be read: " + error.message()
                                                                          : "there is no such folder to resume from");
  if (folder.filename().string().starts_with("step_")) return folder;
  const std::vector<fs::path> all = checkpoints_of(folder);
  if (all.empty() && fs::exists(folder / hash_list)) return folder;
  if (all.empty()) refuse(folder, "there is no checkpoint in this folder; without --resume a run starts from the beginning");
  return all.back();
}

const json* entry_of(const Checkpoint& checkpoint, const std::string& buffer) {
  for (const json& entry : checkpoint.manifest["buffers"])
    if (entry.is_object() && entry.value("name", json()) == buffer) return &entry;
  return nullptr;
}

}  // namespace

std::string checkpoint_name(std::uint64_t step) { return fmt::format("step_{:08}", step); }

std::vector<fs::path> checkpoints_of(const fs::path& run) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(run / "checkpoints", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("step_") && entry.path().extension().empty()) folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  return folders;
}

fs::path write_checkpoint(const fs::path& run, execution::Execution& execution, json about, std::size_t keep) {
  execution.flush();
  const fs::path folder = run / "checkpoints" / checkpoint_name(execution.clock().step);
  fs::path part = folder;
  part += ".part";
  try {
    fs::remove_all(part);
    fs::create_directories(part);
    write_files(part, execution, execution.clock(), std::move(about));
    make_all_durable(part);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(part, ignored);  // a full disk is not to be filled with what is of no use
    throw;
  }
  if (fs::exists(folder)) fs::remove_all(folder);  // of a run that went this way before
  fs::rename(part, folder);
  make_durable(run / "checkpoints");
  remove_older(run, keep);
  return folder;
}

Checkpoint read_checkpoint(const fs::path& folder) {
  const fs::path normal = folder.has_filename() ? folder : folder.parent_path();
  const fs::path found = find_checkpoint(normal);
  try {
    return read_one(found);
  } catch (const config::InputError& error) {
    config::Diagnostic first = error.diagnostics().all().front();
    config::Diagnostics diagnostics;
    diagnostics.error(first.place, first.text + offer(found));
    throw config::InputError(diagnostics);
  }
}

fs::path run_of(const Checkpoint& checkpoint) {
  const fs::path folder = fs::absolute(checkpoint.folder).lexically_normal();
  return folder.parent_path().filename() == "checkpoints" ? folder.parent_path().parent_path() : fs::path();
}

void go_back_to(const Checkpoint& checkpoint, std::size_t keep) {
  const fs::path run = run_of(checkpoint);
  for (const fs::path& each : checkpoints_of(run))
    if (each.filename() > checkpoint.folder.filename()) fs::remove_all(each);
  remove_older(run, std::max<std::size_t>(keep, 1));
}

std::vector<std::string> restore(const Checkpoint& checkpoint, execution::Execution& execution) {
  const graph::Plan& plan = execution.plan();
  const std::vector<int> needed = graph::carried(plan);
  const fs::path manifest = checkpoint.folder / checkpoint_manifest;
  const json sizes = checkpoint.manifest.value("sizes", json::object());
  for (const std::string& domain : resized(plan)) {
    const std::uint64_t room = plan.environment.domains.at(domain).count;
    const json size = sizes.is_object() ? sizes.value(domain, json(room)) : json();
    if (!size.is_number_unsigned() || size.get<std::uint64_t>() > room)
      refuse(manifest, fmt::format("the number of {} in \"sizes\" must be a whole number up to {}", domain, room));
    execution.resize(domain, size.get<std::uint64_t>());
  }
  std::vector<std::string> left_out;
  for (const int b : kept(plan)) {
    const graph::PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(b)];
    const json* entry = entry_of(checkpoint, buffer.name);
    if (entry == nullptr) {
      if (std::ranges::find(needed, b) != needed.end())
        refuse(manifest, fmt::format("has no buffer '{}', which this run needs", buffer.name));
      left_out.push_back(buffer.name);
      continue;
    }
    const auto expect = [&](const char* key, const json& value) {
      if (const json there = entry->value(key, json()); there != value)
        refuse(manifest, fmt::format("\"{}\" of the buffer '{}' is {}, but must be {}", key, buffer.name,
                                     there.dump(-1, ' ', false, json::error_handler_t::replace), value.dump()));
    };
    expect("type", graph::name(buffer.type));
    expect("count", buffer.count);
    expect("file", array_file(buffer.name));
    const fs::path file = checkpoint.folder / array_file(buffer.name);
    try {
      std::uint64_t no_numbers = 0;
      const std::vector<std::byte> contents = unpack(plan, buffer, file, no_numbers);
      if (entry->value("not_a_number", json()) != no_numbers)
        refuse(file, fmt::format("{} of its values are NaN, where the manifest says {}", no_numbers,
                                 entry->value("not_a_number", json()).dump()));
      execution.write(buffer.name, contents);
    } catch (const config::InputError&) {
      throw;
    } catch (const std::runtime_error& error) {
      const std::string text = error.what();
      refuse(file, text.substr(std::min(text.find(": ") + 2, text.size())));
    }
  }
  execution.resume(checkpoint.clock);
  return left_out;
}

}  // namespace firn::app
