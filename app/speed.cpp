#include "app/speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>

#include "app/load.h"
#include "app/statistics.h"
#include "gpu/commands.h"

namespace firn::app {
namespace {

// Of so many the lower quartile: what the device can do when nothing else is in its way.
constexpr int measurements = 15;

gpu::Program kernel(const gpu::Device& device, const std::string& name, const std::string& defines) {
  for (const std::filesystem::path& folder : shader_folders()) {
    const std::filesystem::path file = folder / "measure" / (name + ".comp");
    if (!std::filesystem::is_regular_file(file)) continue;
    gpu::ShaderSource source{device.version_directive() + "\n" + defines, {"generated"}};
    gpu::append_file(source, file, {});
    return {std::array{std::pair{gpu::ShaderKind::compute, source}}, "measure " + name};
  }
  throw gpu::ShaderError(fmt::format("measure/{}.comp: error: no such shader", name));
}

// Seconds of one `call`, which only hands work to the device. So many are issued at once that waiting for them weighs nothing.
double seconds_of(gpu::Device& device, const std::function<void()>& call) {
  const auto time_of = [&](int calls) {
    device.finish();
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) call();
    device.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  constexpr double long_enough = 0.005;
  time_of(1);  // compiles
  int calls = 1;
  for (double seconds = time_of(calls); seconds < long_enough && calls < 100000; seconds = time_of(calls))
    calls = std::max(2 * calls, static_cast<int>(1.2 * calls * long_enough / std::max(seconds, 1e-6)));
  std::vector<double> seconds;
  for (int i = 0; i < measurements; ++i) seconds.push_back(time_of(calls) / calls);
  return quantile(seconds, 0.25);
}

}  // namespace

Speed measure_speed(gpu::Device& device) {
  const gpu::DeviceInfo& info = device.info();
  Speed speed;
  device.label("measuring the device");

  // Beyond every cache, and within every limit.
  const std::uint64_t wanted = info.software ? std::uint64_t{64} << 20 : std::uint64_t{512} << 20;
  const std::uint64_t bytes = std::min(wanted, info.limits.storage_block_bytes) / 4096 * 4096;
  gpu::Buffer from(bytes, "measure from"), to(bytes, "measure to");
  const gpu::Program copy = kernel(device, "copy", "");
  const std::uint64_t groups = bytes / 16 / 256;
  const auto columns = static_cast<std::uint32_t>(std::min<std::uint64_t>(groups, 32768));
  const auto rows = static_cast<std::uint32_t>((groups + columns - 1) / columns);
  speed.copy = 2.0 * static_cast<double>(bytes) / seconds_of(device, [&] {
                 gpu::use(copy);
                 gpu::bind_storage(0, from);
                 gpu::bind_storage(1, to);
                 gpu::dispatch(columns, rows, 1);
               });
  speed.buffer_copy = 2.0 * static_cast<double>(bytes) / seconds_of(device, [&] { gpu::copy(from, to, bytes); });

  constexpr int turns = 256, chains = 8;
  const std::uint32_t work_groups = info.software ? 256 : 16384, group = 64;
  const gpu::Program multiply_add =
      kernel(device, "multiply_add", fmt::format("#define TURNS {}\n#define CHAINS {}\n", turns, chains));
  constexpr std::array<float, 8> factors{0.5F, 0.5F, 0.5F, 0.5F, 1, 1, 1, 1};
  gpu::Buffer constants(sizeof(factors), "measure factors");
  constants.upload(0, std::as_bytes(std::span(factors)));
  gpu::Buffer sums(std::uint64_t{16} * work_groups * group, "measure sums");
  const double operations = 2.0 * 4 * turns * chains * work_groups * group;
  speed.multiply_add = operations / seconds_of(device, [&] {
                         gpu::use(multiply_add);
                         gpu::bind_storage(0, constants);
                         gpu::bind_storage(1, sums);
                         gpu::dispatch(work_groups, 1, 1);
                       });

  const gpu::Program nothing = kernel(device, "nothing", "");
  speed.launch = seconds_of(device, [&] {
    gpu::use(nothing);
    gpu::dispatch(1, 1, 1);
  });
  return speed;
}

nlohmann::json as_json(const Speed& speed) {
  return {{"copy_bytes_per_second", speed.copy},
          {"buffer_copy_bytes_per_second", speed.buffer_copy},
          {"multiply_add_flop_per_second", speed.multiply_add},
          {"launch_seconds", speed.launch}};
}

std::string in_words(double per_second, const std::string& unit) {
  const bool large = per_second >= 1e12;
  return fmt::format("{:.3g} {}{}/s", per_second * (large ? 1e-12 : 1e-9), large ? "T" : "G", unit);
}

}  // namespace firn::app
