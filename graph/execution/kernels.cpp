#include "graph/execution/kernels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/subgroups.h"
#include "graph/execution/stage_file_errors.h"
#include "graph/repeats.h"

namespace firn::execution {
namespace {

using graph::Dispatch;
using graph::Draw;
using graph::ElementType;
using graph::Plan;
using graph::PlannedBuffer;
using graph::PlannedStage;
using graph::Usage;

const PlannedStage& stage_of(const Plan& plan, int stage) { return plan.stages[static_cast<std::size_t>(stage)]; }

gpu::TexelFormat texture_format(ElementType type) {
  switch (type) {
    case ElementType::rgba8:
      return gpu::TexelFormat::rgba8;
    case ElementType::depth:
      return gpu::TexelFormat::depth32f;
    case ElementType::float1:
      return gpu::TexelFormat::r32f;
    case ElementType::vec2:
      return gpu::TexelFormat::rg32f;
    case ElementType::vec3:
    case ElementType::vec4:
      return gpu::TexelFormat::rgba32f;
    case ElementType::int1:
      return gpu::TexelFormat::r32i;
    case ElementType::uint1:
      return gpu::TexelFormat::r32ui;
    default:
      throw std::logic_error(fmt::format("no texture holds {}", graph::name(type)));
  }
}

// Texels as the padded elements lie in memory: mat3 is three of four floats.
gpu::TexelFormat texel_format(ElementType type) {
  const bool single = graph::components(type) == 1;
  const bool pair = graph::components(type) == 2;
  switch (graph::scalar(type)) {
    case graph::Scalar::integer:
      return single ? gpu::TexelFormat::r32i : pair ? gpu::TexelFormat::rg32i : gpu::TexelFormat::rgba32i;
    case graph::Scalar::natural:
      return single ? gpu::TexelFormat::r32ui : pair ? gpu::TexelFormat::rg32ui : gpu::TexelFormat::rgba32ui;
    default:
      return single ? gpu::TexelFormat::r32f : pair ? gpu::TexelFormat::rg32f : gpu::TexelFormat::rgba32f;
  }
}

const std::string& shader_file(const Draw& draw, gpu::ShaderKind kind) {
  switch (kind) {
    case gpu::ShaderKind::vertex:
      return draw.vertex;
    case gpu::ShaderKind::fragment:
      return draw.fragment;
    case gpu::ShaderKind::tessellation_control:
      return draw.tessellation_control;
    default:
      return draw.tessellation_evaluation;
  }
}

std::filesystem::path find_shader(const std::string& file, std::span<const std::filesystem::path> folders) {
  if (is_stage_file(file)) return file;
  std::string searched;
  for (const std::filesystem::path& folder : folders) {
    if (std::filesystem::is_regular_file(folder / file)) return folder / file;
    searched += fmt::format(" {}", folder.string());
  }
  throw gpu::ShaderError(fmt::format("{}: error: no such shader below:{}", file, searched));
}

static_assert(static_cast<int>(gpu::Topology::points) == static_cast<int>(graph::Topology::points) &&
                  static_cast<int>(gpu::Topology::lines) == static_cast<int>(graph::Topology::lines) &&
                  static_cast<int>(gpu::Topology::triangles) == static_cast<int>(graph::Topology::triangles) &&
                  static_cast<int>(gpu::Topology::triangle_strip) == static_cast<int>(graph::Topology::triangle_strip) &&
                  static_cast<int>(gpu::Topology::patches) == static_cast<int>(graph::Topology::patches),
              "kinds of what is drawn are passed on as they are");

gpu::DrawState draw_state(const Draw& draw) {
  gpu::DrawState state;
  state.topology = static_cast<gpu::Topology>(draw.topology);
  state.patch_vertices = draw.patch_vertices;
  state.depth_test = draw.depth.empty() ? gpu::DepthTest::off : gpu::DepthTest::less_equal;
  state.depth_write = !draw.depth.empty() && draw.depth_write;
  state.wireframe = draw.wireframe;
  return state;
}

const gpu::Texture& target_texture(const PlannedStage& stage, const std::string& port, const Memory& memory) {
  const auto at = std::ranges::find(stage.spec.ports, port, &graph::Port::name) - stage.spec.ports.begin();
  return memory.textures[static_cast<std::size_t>(stage.buffers[static_cast<std::size_t>(at)])];
}

gpu::Framebuffer target_of(const PlannedStage& stage, const Draw& draw, const Memory& memory) {
  std::vector<const gpu::Texture*> colors;
  for (const std::string& color : draw.colors) colors.push_back(&target_texture(stage, color, memory));
  return {colors, draw.depth.empty() ? nullptr : &target_texture(stage, draw.depth, memory), stage.label};
}

}  // namespace

graph::DeviceTraits traits_of(const gpu::Device& device) {
  return {device.version_directive(), device.has("GL_NV_shader_atomic_float"), gpu::subgroup_size(device)};
}

Memory::Memory(const Plan& plan, const gpu::Device&) {
  const std::size_t count = plan.buffers.size();
  textures.resize(count);
  texels.resize(count);
  struct Storage {
    std::uint64_t bytes = 0;
    std::string names;
  };
  std::vector<Storage> storages(count);
  for (std::size_t b = 0; b < count; ++b) {
    const PlannedBuffer& buffer = plan.buffers[b];
    storage_of_.push_back(static_cast<std::size_t>(buffer.storage));
    if (buffer.texture) {
      textures[b] = gpu::Texture(buffer.width, buffer.height, texture_format(buffer.type), buffer.name);
      continue;
    }
    Storage& storage = storages[storage_of_[b]];
    storage.bytes = std::max(storage.bytes, buffer.bytes);
    storage.names += (storage.names.empty() ? "" : ", ") + buffer.name;
  }
  storages_.resize(count);
  for (std::size_t b = 0; b < count; ++b)
    if (!storages[b].names.empty()) storages_[b] = gpu::Buffer(storages[b].bytes, storages[b].names);
  for (std::size_t b = 0; b < count; ++b)
    if (const std::vector<std::uint32_t>& initial = plan.buffers[b].initial; !initial.empty())
      buffer(static_cast<int>(b)).upload(0, std::as_bytes(std::span(initial)));
  for (const PlannedStage& stage : plan.stages)
    for (const graph::Work& work : stage.spec.work)
      for (const graph::UsedPort& used : graph::used_ports(stage, work)) {
        const auto b = static_cast<std::size_t>(stage.buffers[static_cast<std::size_t>(used.port)]);
        if (used.usage != Usage::sampled || plan.buffers[b].texture || texels[b].id() != 0) continue;
        texels[b] = gpu::BufferTexture(buffer(static_cast<int>(b)), texel_format(plan.buffers[b].type), plan.buffers[b].name,
                                       plan.buffers[b].bytes);
      }
}

gpu::ShaderSource kernel_source(const Plan& plan, int stage, int work, const std::string& file, gpu::ShaderKind kind,
                                const graph::DeviceTraits& traits, std::span<const std::filesystem::path> shader_folders) {
  gpu::ShaderSource source;
  source.files.emplace_back("generated");
  source.text = kind == gpu::ShaderKind::compute
                    ? graph::compute_prelude(plan, stage, work, traits)
                    : graph::draw_prelude(plan, stage, work, kind == gpu::ShaderKind::fragment, traits);
  const std::filesystem::path path = find_shader(file, shader_folders);
  // A stage that is a file may have its own includes beside it.
  std::vector<std::filesystem::path> folders(shader_folders.begin(), shader_folders.end());
  if (is_stage_file(file)) folders.push_back(path.parent_path());
  try {
    gpu::append_file(source, path, folders);
  } catch (const gpu::ShaderError& error) {
    if (is_stage_file(file)) throw config::InputError(stage_file_errors(error.what(), source, file));
    throw;
  }
  return source;
}

gpu::ProgramSource program_source(const Plan& plan, int stage_index, int work_index, const graph::DeviceTraits& traits,
                                  std::span<const std::filesystem::path> shader_folders) {
  const PlannedStage& stage = stage_of(plan, stage_index);
  const graph::Work& work = stage.spec.work[static_cast<std::size_t>(work_index)];
  gpu::ProgramSource source{{}, stage.label};
  const auto add = [&](const std::string& file, gpu::ShaderKind kind) {
    source.shaders.emplace_back(kind, kernel_source(plan, stage_index, work_index, file, kind, traits, shader_folders));
  };
  using enum gpu::ShaderKind;
  if (const auto* dispatch = std::get_if<Dispatch>(&work)) add(dispatch->kernel, compute);
  if (const auto* draw = std::get_if<Draw>(&work))
    for (const gpu::ShaderKind kind : {vertex, tessellation_control, tessellation_evaluation, fragment})
      if (!shader_file(*draw, kind).empty()) add(shader_file(*draw, kind), kind);
  return source;
}

Kernel make_kernel(const Plan& plan, int stage_index, int work_index, const Memory& memory, const gpu::Device& device) {
  const PlannedStage& stage = stage_of(plan, stage_index);
  const graph::Work& work = stage.spec.work[static_cast<std::size_t>(work_index)];
  Kernel kernel;
  size_kernel(kernel, plan, stage_index, work_index);
  if (!std::holds_alternative<graph::HostWork>(work))
    kernel.interface = graph::kernel_interface(plan, stage_index, work_index, traits_of(device));
  if (const auto* draw = std::get_if<Draw>(&work)) kernel.target = target_of(stage, *draw, memory);
  return kernel;
}

void size_kernel(Kernel& kernel, const Plan& plan, int stage, int work) {
  const auto count = [&](const std::string& domain) { return element_count(domain, plan.environment).value_or(0); };
  const graph::Work& of_stage = stage_of(plan, stage).spec.work[static_cast<std::size_t>(work)];
  if (const auto* dispatch = std::get_if<Dispatch>(&of_stage)) {
    if (!dispatch->over.empty()) kernel.elements = count(dispatch->over);
    kernel.idle = !dispatch->needs.empty() && count(dispatch->needs) == 0;
  }
  if (const auto* draw = std::get_if<Draw>(&of_stage)) {
    kernel.elements = count(draw->instances);
    kernel.vertices = count(draw->vertices);
  }
}

void bind_kernel(const PlannedStage& stage, const Kernel& kernel, const Memory& memory, const StageBlocks& blocks) {
  gpu::use(kernel.program);
  gpu::bind_uniform(graph::parameter_block_binding, blocks.parameters);
  gpu::bind_uniform(graph::clock_block_binding, blocks.clock);
  if (kernel.interface.fault_binding >= 0)
    gpu::bind_storage(static_cast<std::uint32_t>(kernel.interface.fault_binding), blocks.faults);
  for (const graph::PortBinding& binding : kernel.interface.ports) {
    const auto buffer = static_cast<std::size_t>(stage.buffers[static_cast<std::size_t>(binding.port)]);
    const auto at = static_cast<std::uint32_t>(binding.binding);
    switch (binding.usage) {
      case Usage::storage:
        gpu::bind_storage(at, memory.buffer(static_cast<int>(buffer)));
        break;
      case Usage::uniform:
        gpu::bind_uniform(at, memory.buffer(static_cast<int>(buffer)));
        break;
      case Usage::sampled:
        if (binding.texture)
          gpu::bind_texture(at, memory.textures[buffer]);
        else
          gpu::bind_texture(at, memory.texels[buffer]);
        break;
      case Usage::image:
        gpu::bind_image(at, memory.textures[buffer]);
        break;
      case Usage::indirect:
        gpu::bind_indirect(memory.buffer(static_cast<int>(buffer)));
        break;
      case Usage::vertex:
      case Usage::transfer:
      case Usage::host:
      case Usage::framebuffer:
        break;
    }
  }
}

void run_kernel(const PlannedStage& stage, const graph::Run& run, const Kernel& kernel, const Memory& memory,
                const StageBlocks& blocks) {
  bind_kernel(stage, kernel, memory, blocks);
  const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
  if (const auto* dispatch = std::get_if<Dispatch>(&work)) {
    if (!dispatch->indirect.empty()) {
      gpu::dispatch_indirect(0);
    } else if (run.groups.buffer >= 0) {
      gpu::bind_indirect(memory.buffer(run.groups.buffer));
      gpu::dispatch_indirect(3 * sizeof(std::uint32_t) * static_cast<std::uint64_t>(run.groups.slot));
    } else if (kernel.elements > 0) {
      const auto [x, y, z] = graph::group_counts(kernel.elements, dispatch->group);
      gpu::dispatch(x, y, z);
    }
  } else if (const auto* draw = std::get_if<Draw>(&work)) {
    if (draw->clear) {
      // Colors are not cleared in vain: llvmpipe takes at least three times as long for them as for a depth.
      if (draw->depth.empty())
        for (int color = 0; color < static_cast<int>(draw->colors.size()); ++color)
          gpu::clear_color(kernel.target, color, 0, 0, 0, 0);
      else
        gpu::clear_depth(kernel.target, 1);
    }
    if (kernel.elements > 0 && kernel.vertices > 0)
      gpu::draw(kernel.target, draw_state(*draw), static_cast<std::uint32_t>(kernel.vertices),
                static_cast<std::uint32_t>(kernel.elements));
  }
}

void rehearse_kernel(const PlannedStage& stage, int work, const Kernel& kernel, const Memory& memory, const StageBlocks& blocks) {
  bind_kernel(stage, kernel, memory, blocks);
  if (const auto* draw = std::get_if<Draw>(&stage.spec.work[static_cast<std::size_t>(work)])) {
    // Contexts do not share targets.
    gpu::rehearse_draw(target_of(stage, *draw, memory), draw_state(*draw));
    return;
  }
  // The driver learns too late that there is nothing to run.
  const std::array<std::uint32_t, 3> none{};
  gpu::Buffer no_groups(sizeof(none), "no groups");
  no_groups.upload(0, std::as_bytes(std::span(none)));
  gpu::bind_indirect(no_groups);
  gpu::dispatch_indirect(0);
}

}  // namespace firn::execution
