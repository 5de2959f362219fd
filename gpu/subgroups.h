#pragma once

#include "gpu/device.h"

namespace firn::gpu {

// Invocations of a subgroup in compute shaders; 0: the device has not GL_KHR_shader_subgroup there.
int subgroup_size(const Device& device);

}  // namespace firn::gpu
