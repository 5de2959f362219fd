#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/load.h"
#include "app/program_cache.h"
#include "app/speed.h"
#include "app/verbs.h"
#include "app/version.h"
#include "gpu/device.h"
#include "gpu/program_cache.h"
#include "graph/execution/execution.h"

namespace firn::app {
namespace {

// What Firn's own pipelines need at most of a device, beyond OpenGL 4.3 itself.
std::vector<std::string> verdict(const gpu::DeviceInfo& info) {
  std::vector<std::string> remarks;
  if (info.limits.storage_blocks_compute < 12)
    remarks.push_back(fmt::format("{} storage blocks per compute shader: stages with more ports are refused",
                                  info.limits.storage_blocks_compute));
  if (!info.extensions.contains("GL_NV_shader_atomic_float"))
    remarks.push_back("no GL_NV_shader_atomic_float: `accumulate: float` uses a compare-and-swap loop, which is slower");
  if (info.program_binary_formats == 0)
    remarks.push_back("the driver hands out no compiled programs: shaders are compiled anew at every start");
  if (!info.extensions.contains("GL_KHR_shader_subgroup"))
    remarks.push_back("no GL_KHR_shader_subgroup: `form: subgroup` is refused; `form: shared` needs no extension");
  if (info.software) remarks.push_back("a software renderer: everything works, on the CPU; draws cannot be timed by time stamps");
  return remarks;
}

nlohmann::json as_json(const gpu::DeviceInfo& info) {
  const gpu::Limits& limits = info.limits;
  return {{"name", info.name},
          {"vendor", info.vendor},
          {"version", info.version},
          {"software", info.software},
          {"limits",
           {{"storage_blocks_compute", limits.storage_blocks_compute},
            {"storage_block_bytes", limits.storage_block_bytes},
            {"texture_buffer_texels", limits.texture_buffer_texels},
            {"texture_size", limits.texture_size},
            {"group_invocations", limits.group_invocations},
            {"shared_bytes", limits.shared_bytes}}}};
}

// Where compiled programs are kept, and what is there.
struct Kept {
  std::string folder;  // empty: nowhere
  gpu::ProgramCache::Size size;
};
Kept kept_programs() {
  const std::filesystem::path folder = program_cache_folder();
  if (folder.empty()) return {};
  return {folder.string(), gpu::ProgramCache(folder).size()};
}

nlohmann::json as_json(const Kept& kept) {
  return {{"folder", kept.folder},
          {"programs", kept.size.entries},
          {"bytes", kept.size.bytes},
          {"most_bytes", gpu::ProgramCache::usual_bytes}};
}

std::string in_words(const Kept& kept) {
  if (kept.folder.empty()) return "kept nowhere: FIRN_CACHE is off, or there is no home folder";
  constexpr double mebibyte = 1 << 20;
  return fmt::format("{} in {}, {:.1f} MiB of at most {:.0f}", kept.size.entries, kept.folder,
                     static_cast<double>(kept.size.bytes) / mebibyte,
                     static_cast<double>(gpu::ProgramCache::usual_bytes) / mebibyte);
}

bool on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::stringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (std::filesystem::exists(std::filesystem::path(folder) / program)) return true;
  return false;
}

}  // namespace

void add_doctor(CLI::App& program, Action& action) {
  const auto json = std::make_shared<bool>(false);
  const auto choice = std::make_shared<std::string>("auto");
  CLI::App* verb = program.add_subcommand("doctor", "Devices, driver, limits; what will not work here, and why");
  verb->add_flag("--json", *json, "As JSON");
  verb->add_option("--device", *choice, "auto, hardware, software, a number of the list, or a part of a name")
      ->capture_default_str();
  verb->callback([&action, json, choice] {
    action = [json, choice] {
      const std::vector<gpu::Device::Candidate> candidates = gpu::Device::candidates();
      nlohmann::json list = nlohmann::json::array();
      if (!*json) fmt::print("{}\n\ndevices\n", version_line());
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const gpu::Device::Candidate& candidate = candidates[i];
        nlohmann::json entry = as_json(candidate.info);
        entry["where"] = candidate.where;
        entry["problem"] = candidate.problem;
        list.push_back(entry);
        if (!*json)
          fmt::print(
              "  {}  {}: {}\n", i, candidate.where,
              candidate.problem.empty() ? fmt::format("{}, {}", candidate.info.name, candidate.info.version) : candidate.problem);
      }
      const std::unique_ptr<gpu::Device> device = gpu::Device::open(*choice);
      const gpu::DeviceInfo& info = device->info();
      std::vector<std::string> remarks = verdict(info);
      Speed speed;
      try {
        speed = measure_speed(*device);
      } catch (const std::runtime_error& error) {
        remarks.push_back(fmt::format("its speed cannot be measured: {}", error.what()));
      }
      const Kept kept = kept_programs();
      if (*json) {
        const nlohmann::json report = {{"version", version()},         {"devices", list},
                                       {"used", as_json(info)},        {"speed", as_json(speed)},
                                       {"remarks", remarks},           {"compiled_programs", as_json(kept)},
                                       {"ffmpeg", on_path("ffmpeg")},  {"graphviz", on_path("dot")},
                                       {"gnuplot", on_path("gnuplot")}};
        fmt::print("{}\n", report.dump(2));
        return static_cast<int>(Status::done);
      }
      const gpu::Limits& limits = info.limits;
      fmt::print("\nused\n  {} ({}), {}\n", info.name, info.vendor, info.version);
      fmt::print("  storage blocks per compute shader   {}\n  bytes per storage block             {}\n",
                 limits.storage_blocks_compute, limits.storage_block_bytes);
      fmt::print("  texels per buffer texture           {}\n  texture size                        {}\n",
                 limits.texture_buffer_texels, limits.texture_size);
      fmt::print("  invocations per work group          {}\n  shared memory per work group        {}\n", limits.group_invocations,
                 limits.shared_bytes);
      fmt::print("  copy by a kernel, read and written  {}\n  copy from buffer to buffer          {}\n", in_words(speed.copy, "B"),
                 in_words(speed.buffer_copy, "B"));
      fmt::print("  multiply-adds of 32-bit floats      {}\n  from one launch to the next         {:.2f} us\n",
                 in_words(speed.multiply_add, "FLOP"), 1e6 * speed.launch);
      fmt::print("  compiled programs                   {}\n", in_words(kept));
      fmt::print("\nprograms\n  ffmpeg    {}\n  Graphviz  {}\n  gnuplot   {}\n",
                 on_path("ffmpeg") ? "found" : "not found: no video, pictures only",
                 on_path("dot") ? "found" : "not found: explain writes no svg",
                 on_path("gnuplot") ? "found" : "not found: bench draws no plots");
      fmt::print("\nremarks\n");
      if (remarks.empty()) fmt::print("  none: everything works here\n");
      for (const std::string& remark : remarks) fmt::print("  {}\n", remark);
      return static_cast<int>(Status::done);
    };
  });
}

}  // namespace firn::app
