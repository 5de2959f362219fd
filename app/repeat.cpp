#include "app/repeat.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/identity.h"
#include "app/manifest.h"

namespace firn::app {

using nlohmann::json;

bool tell_of_repeat(const json& manifest, const json& identity, const std::string& device, const json& outputs) {
  const json& before = manifest["outputs"];
  std::size_t same = 0, different = 0;
  for (const auto& [name, hash] : before.items()) {
    const auto now = outputs.find(name);
    if (now != outputs.end() && *now == hash) {
      ++same;
      continue;
    }
    ++different;
    fmt::print("{} {}\n", now == outputs.end() ? "missing:" : "different:", name);
  }
  for (const auto& [name, hash] : outputs.items())
    if (!before.contains(name)) {
      ++different;
      fmt::print("new: {}\n", name);
    }
  fmt::print("{} of {} outputs are the same\n", same, same + different);
  if (different == 0) return true;

  for (const std::string& change : differences(identity_in(manifest), identity)) spdlog::warn("{}", change);
  const json program = program_json();
  if (manifest.value("firn", json()) != program["firn"] || manifest.value("revision", json()) != program["revision"])
    spdlog::warn("the first run was made by another build of Firn");
  if (const json there = manifest.value("device", json::object()); there.is_object() && there.value("name", json()) != device)
    spdlog::warn("the first run was made on another device: {}", there.value("name", json()).dump());
  if (const json resumed = manifest.value("resumed_from", json::array());
      resumed.is_array() && !resumed.empty() && before.contains("video.mp4"))
    spdlog::warn("the first run went on from a checkpoint: its film was encoded in other parts, and has other bytes");
  return false;
}

}  // namespace firn::app
