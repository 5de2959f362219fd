#include "stages/forms.h"

#include <fmt/format.h>

#include "graph/glsl.h"
#include "stages/mpm_ports.h"

namespace firn::stages {
namespace {

std::uint64_t sum_bytes(const graph::Environment& environment) {
  return graph::element_count(mpm::block_sum_values, environment).value_or(0) * sizeof(float);
}

}  // namespace

DeviceProfile assumed_hardware(bool subgroups) {
  return {.name = subgroups ? "hardware with subgroups" : "hardware",
          .assumed = true,
          .software = false,
          .subgroup_size = subgroups ? 32 : 0,
          .storage_block_bytes = std::uint64_t{2} << 30};
}

Forms forms_for(const DeviceProfile& device, const graph::Environment& environment) {
  if (device.software)
    return {{{"form", "texture"}, {"nodes", "by_cell"}},
            "software renderers are fastest at texture fetches, and slow where a group waits for its invocations"};
  constexpr double mebi = 1 << 20;
  if (const std::uint64_t bytes = sum_bytes(environment); bytes > device.storage_block_bytes)
    return {
        {{"form", "texture"}, {"nodes", "by_block"}},
        fmt::format("hardware, but sums of {} blocks would take {:.0f} MiB, and its storage blocks hold {:.0f}; fewer 'blocks' in "
                    "the scene's domain would fit",
                    environment.domains.at("grid_blocks").count, static_cast<double>(bytes) / mebi,
                    static_cast<double>(device.storage_block_bytes) / mebi)};
  if (device.subgroup_size >= graph::least_subgroup)
    return {{{"form", "subgroup"}, {"nodes", "by_block"}},
            fmt::format("hardware with subgroups of {} invocations ({} is enough), which need not wait for their whole group",
                        device.subgroup_size, graph::least_subgroup)};
  return {{{"form", "shared"}, {"nodes", "by_block"}},
          device.subgroup_size > 0 ? fmt::format("hardware, whose subgroups of {} invocations are too small ({} is enough)",
                                                 device.subgroup_size, graph::least_subgroup)
                                   : fmt::format("hardware, without {}", graph::subgroup_extension)};
}

}  // namespace firn::stages
