#include <zstd.h>

#include <map>

#include "app/checkpoint.h"
#include "app/checkpoint_files.h"
#include "app/identity.h"
#include "app/manifest.h"
#include "app/packed_array.h"
#include "app/run_start.h"
#include "app/sha256.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/refusal.h"

namespace firn::fuzz {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// One buffer of four particles, and what a plan and a manifest say of it.
graph::PlannedBuffer small_buffer() {
  graph::PlannedBuffer buffer;
  buffer.name = "position";
  buffer.type = graph::ElementType::vec3;
  buffer.domain = "particles";
  buffer.count = 4;
  buffer.bytes = 64;
  return buffer;
}

json small_manifest() {
  return {{"format", "firn checkpoint"},
          {"version", 1},
          {"step", 4},
          {"frame", 1},
          {"time", 0.5},
          {"dt", 0.1},
          {"identity", {{"pipeline", {{"stages", json::array()}}}}},
          {"inputs", app::to_json({})},
          {"buffers", {{{"name", "position"}, {"file", "position.npy.zst"}, {"type", "vec3"}, {"count", 4}, {"not_a_number", 0}}}}};
}

std::string compressed(std::string_view plain) {
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 1));
  return packed;
}

}  // namespace

void check_checkpoint(const Sandbox& sandbox, std::string_view bytes) {
  if (bytes.empty()) return;
  const graph::PlannedBuffer buffer = small_buffer();
  const graph::Plan plan;
  const std::vector<std::byte> zeros(buffer.bytes);
  const std::string content(bytes.substr(1));
  std::map<std::string, std::string> files{{app::checkpoint_manifest, small_manifest().dump()},
                                           {app::array_file(buffer.name), app::pack(plan, buffer, zeros).file}};
  if (bytes[0] == 'm') files[app::checkpoint_manifest] = content;
  if (bytes[0] == 'a') files[app::array_file(buffer.name)] = content;
  if (bytes[0] == 'p') files[app::array_file(buffer.name)] = compressed(content);
  const fs::path folder = sandbox.path() / "step_00000004";
  fs::create_directory(folder);
  std::map<std::string, std::string> hashes;
  for (const auto& [name, text] : files) {
    sandbox.put("step_00000004/" + name, text);
    hashes[name] = app::sha256(text);
  }
  sandbox.put("step_00000004/" + std::string(app::hash_list), bytes[0] == 'h' ? content : app::hash_lines(hashes));

  read_or_refuse(folder, [&] {
    const app::Checkpoint checkpoint = app::read_checkpoint(folder);
    const app::RunOptions options = app::options_from(checkpoint.manifest["inputs"], (folder / "manifest.json").string());
    static_cast<void>(app::to_json(options));
    static_cast<void>(app::differences(checkpoint.manifest["identity"], small_manifest()["identity"]));
  });
  const fs::path array = folder / app::array_file(buffer.name);
  read_or_refuse(array, [&] {
    std::uint64_t no_numbers = 0;
    if (app::unpack(plan, buffer, array, no_numbers).size() != buffer.bytes) throw std::logic_error("another size");
  });
}

void check_manifest(const Sandbox& sandbox, std::string_view bytes) {
  app::RunOptions options;
  options.from = sandbox.put("manifest.json", bytes).string();
  read_or_refuse(options.from, [&] {
    const app::RunStart start = app::run_start(options);
    static_cast<void>(app::differences(app::identity_in(start.repeated), small_manifest()["identity"]));
  });
}

}  // namespace firn::fuzz
