#include "app/manifest.h"

#include <algorithm>

#include "app/files.h"
#include "app/metrics.h"
#include "app/sha256.h"
#include "app/version.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json limits_json(const gpu::Limits& limits) {
  return {{"storage_blocks_compute", limits.storage_blocks_compute},
          {"storage_bindings", limits.storage_bindings},
          {"storage_block_bytes", limits.storage_block_bytes},
          {"uniform_blocks_compute", limits.uniform_blocks_compute},
          {"uniform_block_bytes", limits.uniform_block_bytes},
          {"texture_units_compute", limits.texture_units_compute},
          {"texture_buffer_texels", limits.texture_buffer_texels},
          {"texture_size", limits.texture_size},
          {"groups", limits.groups},
          {"group_invocations", limits.group_invocations},
          {"shared_bytes", limits.shared_bytes},
          {"memory_bytes", limits.memory_bytes}};
}

}  // namespace

json program_json() {
  const Revision built_from = revision();
  return {{"firn", version()}, {"revision", {{"commit", built_from.commit}, {"changes", built_from.changes}}}};
}

json manifest(const Loaded& loaded, const json& identity, const gpu::DeviceInfo& device, const RunOptions& options,
              const RunFacts& facts) {
  json result = program_json();
  result.update(
      {{"command", facts.command},
       {"started", facts.started},
       {"resumed_from", facts.resumed_from},
       {"inputs", to_json(options)},
       {"pipeline", identity.at("pipeline")},
       {"scene",
        {{"file", loaded.scene_file},
         {"name", loaded.problem->scene.name},
         {"seed", loaded.problem->scene.seed},
         {"resolved", identity.at("scene")}}},
       {"files", identity.at("files")},
       {"sizes", identity.at("sizes")},
       {"shaders", identity.at("shaders")},
       {"device",
        {{"name", device.name}, {"vendor", device.vendor}, {"version", device.version}, {"limits", limits_json(device.limits)}}},
       {"result",
        {{"exit_status", facts.exit_status ? json(*facts.exit_status) : json()},
         {"message", facts.message},
         {"ended", facts.exit_status ? json(now_in_utc()) : json()},
         {"steps", facts.steps},
         {"frames", facts.frames},
         {"simulated_seconds", facts.time},
         {"seconds", facts.seconds}}},
       {"outputs", facts.outputs}});
  result["pipeline"]["file"] = loaded.pipeline_file;
  return result;
}

json identity_in(const json& manifest) {
  json identity = json::object();
  for (const char* part : {"pipeline", "files", "sizes", "shaders"})
    identity[part] = manifest.contains(part) && manifest[part].is_object() ? manifest[part] : json::object();
  if (manifest.contains("scene") && manifest["scene"].is_object()) identity["scene"] = manifest["scene"].value("resolved", json());
  return identity;
}

void write_manifest(const fs::path& file, const json& manifest) {
  // File names need not be UTF-8, JSON must be.
  replace_file(file, manifest.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

json hashes_of_outputs(const fs::path& run, const std::vector<NamedFile>& dumps) {
  json hashes = json::object();
  const auto add = [&](const fs::path& file) { hashes[fs::relative(file, run).string()] = sha256_of(file); };
  if (const fs::path metrics = run / "metrics.csv"; fs::is_regular_file(metrics)) hashes["metrics.csv"] = hash_of_metrics(metrics);
  if (const fs::path film = run / "video.mp4"; fs::is_regular_file(film)) add(film);
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(run / "frames", error))
    if (const std::string name = entry.path().filename().string(); name.starts_with("frame_") && name.ends_with(".png"))
      add(entry.path());
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run / "export", error))
    if (entry.is_regular_file() && entry.path().extension() != ".part") add(entry.path());
  for (const NamedFile& dump : dumps)
    if (fs::is_regular_file(dump.file)) hashes["dump " + dump.name] = sha256_of(dump.file);
  return hashes;
}

}  // namespace firn::app
