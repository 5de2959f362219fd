#pragma once

// The programs of all kernels of a plan.

#include <functional>
#include <vector>

#include "gpu/program_cache.h"
#include "graph/execution/kernels.h"

namespace firn::execution {

// Gives every kernel its program: from the cache (null: there is none), or compiled, as many at once as pays. Throws
// config::InputError with what is wrong with stages that are files, else gpu::ShaderError with what is wrong with any of them.
// `rehearse`: to rehearse_kernel() it, in whichever context is current.
void make_programs(const graph::Plan& plan, std::vector<std::vector<Kernel>>& kernels, gpu::Device& device,
                   std::span<const std::filesystem::path> shader_folders, const gpu::ProgramCache* cache,
                   const std::function<void(int stage, int work)>& rehearse);

}  // namespace firn::execution
