#include "app/device_profile.h"

#include "gpu/subgroups.h"

namespace firn::app {

stages::DeviceProfile profile_of(const gpu::Device& device) {
  const gpu::DeviceInfo& info = device.info();
  return {.name = info.name,
          .assumed = false,
          .software = info.software,
          .subgroup_size = gpu::subgroup_size(device),
          .storage_block_bytes = info.limits.storage_block_bytes};
}

stages::DeviceProfile profile_for(const std::string& choice) {
  if (choice == "software") return {};
  if (choice == "hardware" || choice == "subgroups") return stages::assumed_hardware(choice == "subgroups");
  return profile_of(*gpu::Device::open(choice));
}

}  // namespace firn::app
