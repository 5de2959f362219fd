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

// Extensions of GLSL that stages of the plan need and the device has not, one sentence each; empty: none.
std::vector<std::string> missing_extensions(const graph::Plan& plan, const graph::DeviceTraits& traits);

// Every buffer and texture of a plan, and the buffer textures that its kernels read through.
struct Memory {
  Memory(const graph::Plan& plan, const gpu::Device& device);

  [[nodiscard]] const gpu::Buffer& buffer(int planned) const { return storages_[storage_of_[static_cast<std::size_t>(planned)]]; }
  [[nodiscard]] gpu::Buffer& buffer(int planned) { return storages_[storage_of_[static_cast<std::size_t>(planned)]]; }

  std::vector<gpu::Texture> textures;      // by planned buffer; empty where it is a buffer
  std::vector<gpu::BufferTexture> texels;  // by planned buffer; empty where nobody samples it

 private:
  std::vector<std::size_t> storage_of_;  // by planned buffer
  std::vector<gpu::Buffer> storages_;
};

// One dispatch or draw. Host work has an empty program.
struct Kernel {
  gpu::Program program;
  graph::KernelInterface interface;
  gpu::Framebuffer target;     // draws
  std::uint64_t elements = 0;  // dispatches: invocations; draws: instances
  std::uint64_t vertices = 0;
  bool idle = false;  // a dispatch that needs elements of a domain without any; it is not to be run
};

// All of it but the program (programs.h).
Kernel make_kernel(const graph::Plan& plan, int stage, int work, const Memory& memory, const gpu::Device& device);

// What its program is made of; no shaders for host work. Throws config::InputError where the file of a stage includes what is not
// there.
gpu::ProgramSource program_source(const graph::Plan& plan, int stage, int work, const graph::DeviceTraits& traits,
                                  std::span<const std::filesystem::path> shader_folders);

// The full source of one kernel, for people: prelude and file with its includes.
gpu::ShaderSource kernel_source(const graph::Plan& plan, int stage, int work, const std::string& file, gpu::ShaderKind kind,
                                const graph::DeviceTraits& traits, std::span<const std::filesystem::path> shader_folders);

// How many invocations, instances and vertices the plan has for it, as its domains stand.
void size_kernel(Kernel& kernel, const graph::Plan& plan, int stage, int work);

// What all kernels of a stage are bound to beside the buffers of its ports.
struct StageBlocks {
  const gpu::Buffer& parameters;
  const gpu::Buffer& clock;
  const gpu::Buffer& faults;
};

// Binds everything the kernel touches.
void bind_kernel(const graph::PlannedStage& stage, const Kernel& kernel, const Memory& memory, const StageBlocks& blocks);
// Binds, and runs it.
void run_kernel(const graph::PlannedStage& stage, const graph::Run& run, const Kernel& kernel, const Memory& memory,
                const StageBlocks& blocks);

// Binds, and runs it on next to nothing, in whichever context is current, so that a driver makes its machine code, which depends on
// what is bound. Leaves nothing anywhere.
void rehearse_kernel(const graph::PlannedStage& stage, int work, const Kernel& kernel, const Memory& memory,
                     const StageBlocks& blocks);

}  // namespace firn::execution
