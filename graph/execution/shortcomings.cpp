#include <fmt/format.h>

#include <algorithm>

#include "graph/execution/execution.h"
#include "graph/execution/kernels.h"
#include "graph/glsl.h"

namespace firn::execution {

using graph::Plan;
using graph::PlannedBuffer;
using graph::PlannedStage;

std::vector<std::string> shortcomings(const Plan& plan, const gpu::Limits& limits) {
  std::vector<std::string> found;
  if (limits.memory_bytes > 0 && plan.bytes > limits.memory_bytes)
    found.push_back(fmt::format("all buffers together need {} bytes; the device has {}", plan.bytes, limits.memory_bytes));
  for (const PlannedBuffer& buffer : plan.buffers) {
    if (!buffer.texture && buffer.bytes > limits.storage_block_bytes)
      found.push_back(fmt::format("buffer '{}' needs {} bytes; the device's storage blocks hold {}", buffer.name, buffer.bytes,
                                  limits.storage_block_bytes));
    if (buffer.texture && std::max(buffer.width, buffer.height) > limits.texture_size)
      found.push_back(fmt::format("image '{}' is {} x {}; the device's textures end at {}", buffer.name, buffer.width,
                                  buffer.height, limits.texture_size));
  }
  for (int s = 0; s < static_cast<int>(plan.stages.size()); ++s) {
    const PlannedStage& stage = plan.stages[static_cast<std::size_t>(s)];
    for (int w = 0; w < static_cast<int>(stage.spec.work.size()); ++w) {
      const auto* dispatch = std::get_if<graph::Dispatch>(&stage.spec.work[static_cast<std::size_t>(w)]);
      if (dispatch == nullptr) continue;
      const graph::KernelInterface interface = graph::kernel_interface(plan, s, w, {});
      if (interface.storage_blocks > limits.storage_blocks_compute)
        found.push_back(fmt::format("{} ({}) needs {} storage blocks; the device has {} per compute shader", stage.label,
                                    dispatch->kernel, interface.storage_blocks, limits.storage_blocks_compute));
      if (static_cast<std::uint32_t>(dispatch->group) > limits.group_invocations)
        found.push_back(fmt::format("{} ({}) needs work groups of {}; the device's end at {}", stage.label, dispatch->kernel,
                                    dispatch->group, limits.group_invocations));
    }
    for (const graph::Work& work : stage.spec.work)
      for (const graph::UsedPort& used : graph::used_ports(stage, work)) {
        const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(stage.buffers[static_cast<std::size_t>(used.port)])];
        const std::uint64_t texels = buffer.count * (buffer.type == graph::ElementType::mat3 ? 3 : 1);
        if (used.usage == graph::Usage::sampled && !buffer.texture && texels > limits.texture_buffer_texels)
          found.push_back(fmt::format("{} reads '{}' as {} texels; the device's buffer textures hold {}", stage.label, buffer.name,
                                      texels, limits.texture_buffer_texels));
      }
  }
  return found;
}

std::vector<std::string> missing_extensions(const Plan& plan, const graph::DeviceTraits& traits) {
  std::vector<std::string> found;
  for (const PlannedStage& stage : plan.stages)
    if (graph::needs_subgroups(stage) && traits.subgroup_size < graph::least_subgroup)
      found.push_back(
          traits.subgroup_size == 0
              ? fmt::format("{} with 'form: subgroup' needs {}, which the device has not; 'form: shared' needs no extension",
                            stage.label, graph::subgroup_extension)
              : fmt::format("{} with 'form: subgroup' needs subgroups of {} invocations; the device's have {}; 'form: "
                            "shared' needs none",
                            stage.label, graph::least_subgroup, traits.subgroup_size));
  return found;
}

}  // namespace firn::execution
