#pragma once

// The GPU side of one planned stage: programs and what is bound for each piece of its work.

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"
#include "graph/glsl.h"
#include "graph/plan.h"

namespace firn::execution {

graph::DeviceTraits traits_of(const gpu::Device& device);

// Every buffer and texture of a plan, and the buffer textures that its kernels read through.
struct Memory {
  Memory(const graph::Plan& plan, const gpu::Device& device);

  std::vector<gpu::Buffer> buffers;        // by planned buffer; empty where it is a texture
  std::vector<gpu::Texture> textures;      // by planned buffer; empty where it is a buffer
  std::vector<gpu::BufferTexture> texels;  // by planned buffer; empty where nobody samples it
};

// One dispatch or draw, ready to run. Host work has an empty program.
struct Kernel {
  gpu::Program program;
  graph::KernelInterface interface;
  gpu::Framebuffer target;     // draws
  std::uint64_t elements = 0;  // dispatches: invocations; draws: instances
  std::uint64_t vertices = 0;
};

Kernel make_kernel(const graph::Plan& plan, int stage, int work, const Memory& memory, const gpu::Device& device,
                   std::span<const std::filesystem::path> shader_folders);

// The full source of one kernel, for people: prelude and file with its includes.
gpu::ShaderSource kernel_source(const graph::Plan& plan, int stage, int work, const std::string& file, gpu::ShaderKind kind,
                                const graph::DeviceTraits& traits, std::span<const std::filesystem::path> shader_folders);

// Binds everything the kernel touches, and runs it.
void run_kernel(const graph::Plan& plan, int stage, int work, const Kernel& kernel, const Memory& memory,
                const gpu::Buffer& parameters, const gpu::Buffer& clock, const gpu::Buffer& faults);

}  // namespace firn::execution
