#pragma once

// The generated part of a kernel's source: version, work group, parameters, constants, buffers, faults - everything that the spec
// declares.
//
// In a kernel, beside its own code:
//   parameters      numbers and vectors by name (uniforms: changing one compiles nothing); booleans as `const bool`; for every
//   choice
//                   one #define <PARAMETER>_<CHOICE> 0 or 1 (KERNEL_CUBIC)
//   constants       of the environment that the spec lists, by name
//   clock           float dt, time; uint step, frame
//   sizes           uint <domain>_count for every domain that a port of the stage names
//   storage ports   arrays by name: position[i]. `accumulate` ports are arrays of their scalars, padding included: component c of
//   element i of
//                   a vec3 is name[4 * i + c]. #include "lib/accumulate.glsl" adds to them; FIRN_FLOAT_ATOMICS says whether the
//                   device adds floats
//   sampled ports   of buffers: <name>_at(int index); of textures: sampler2D <name> (isampler2D, usampler2D of whole numbers)
//   uniform ports   by name; arrays where the count is above 1
//   image ports     image2D <name> (iimage2D, uimage2D)
//   optional ports  #define HAS_<PORT> 0 or 1
//   subgroups       FIRN_SUBGROUPS 1 in stages with `form: subgroup`, where the device has them (lib/subgroups.glsl)
//   faults          fault(FAULT_NOT_A_NUMBER | FAULT_OVERFLOW | FAULT_LEFT_DOMAIN)
//   uint element_index()  number of this invocation; may exceed the domain: compare with the count

#include <cstddef>
#include <string>
#include <vector>

#include "graph/plan.h"

namespace firn::graph {

inline constexpr int parameter_block_binding = 0;
inline constexpr int clock_block_binding = 1;
inline constexpr int first_uniform_binding = 2;

// Where one port of one piece of work is bound.
struct PortBinding {
  int port = 0;  // index into the spec's ports
  Usage usage = Usage::storage;
  bool texture = false;  // the port's resource is a texture
  int binding = 0;       // storage block, uniform block, texture unit or image unit
};

// What a stage with `form: subgroup` needs of a device.
inline constexpr const char* subgroup_extension = "GL_KHR_shader_subgroup_basic";
inline constexpr int least_subgroup = 16;  // invocations
bool needs_subgroups(const PlannedStage& stage);

struct DeviceTraits {
  std::string version_directive = "#version 430 core";
  bool float_atomics = false;  // GL_NV_shader_atomic_float
  int subgroup_size = 0;       // of subgroup_extension in compute shaders; 0: it has none
};

struct KernelInterface {
  std::vector<PortBinding> ports;
  int storage_blocks = 0;    // with the one for faults
  int fault_binding = -1;    // storage block; -1: reports none
  std::string declarations;  // without the version line and local size
};

// The bound ports of one piece of work, as indices into the stage's ports, with what this work does to them.
struct UsedPort {
  int port = 0;
  Access access = Access::read;
  Usage usage = Usage::storage;
};
std::vector<UsedPort> used_ports(const PlannedStage& stage, const Work& work);

KernelInterface kernel_interface(const Plan& plan, int stage, int work, const DeviceTraits& traits);

// The text before a compute kernel: version, extensions, local size, declarations.
std::string compute_prelude(const Plan& plan, int stage, int work, const DeviceTraits& traits);
// The text before a shader of a draw.
std::string draw_prelude(const Plan& plan, int stage, int work, bool fragment, const DeviceTraits& traits);

// The contents of the parameter block (std140), matching `declarations`.
std::vector<std::byte> parameter_block(const Plan& plan, int stage);

}  // namespace firn::graph
