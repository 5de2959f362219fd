#pragma once

// The device that forms of kernels are chosen for.

#include "gpu/device.h"
#include "stages/forms.h"

namespace firn::app {

stages::DeviceProfile profile_of(const gpu::Device& device);

// For verbs that run nothing: "software", "hardware" and "subgroups" are assumed; anything else is opened and asked.
stages::DeviceProfile profile_for(const std::string& choice);

}  // namespace firn::app
