#include "gpu/subgroups.h"

#include "gpu/context.h"

namespace firn::gpu {
namespace {

// GL_KHR_shader_subgroup, which not every loader knows.
constexpr GLenum size_name = 0x9532, stages_name = 0x9533, features_name = 0x9534;
constexpr unsigned basic_feature = 1;

unsigned value_of(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return static_cast<unsigned>(value);
}

}  // namespace

int subgroup_size(const Device& device) {
  if (!device.has("GL_KHR_shader_subgroup")) return 0;
  const bool computes = (value_of(stages_name) & GL_COMPUTE_SHADER_BIT) != 0 && (value_of(features_name) & basic_feature) != 0;
  const unsigned size = value_of(size_name);
  device.check();
  return computes ? static_cast<int>(size) : 0;
}

}  // namespace firn::gpu
