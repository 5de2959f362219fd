#pragma once

// The immutable result of compiling a pipeline: what is executed, in which order, on which buffers, with which barriers and why.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "graph/environment.h"
#include "graph/host.h"
#include "graph/pipeline.h"
#include "graph/spec.h"

namespace firn::graph {

// Bits of a barrier, by how data is accessed after it. The values are our own; gpu/commands.h has OpenGL's.
enum Bit : std::uint32_t {
  bit_vertex_attrib_array = 1u << 0,
  bit_element_array = 1u << 1,
  bit_uniform = 1u << 2,
  bit_texture_fetch = 1u << 3,
  bit_shader_image_access = 1u << 4,
  bit_command = 1u << 5,
  bit_pixel_buffer = 1u << 6,
  bit_texture_update = 1u << 7,
  bit_buffer_update = 1u << 8,
  bit_framebuffer = 1u << 9,
  bit_shader_storage = 1u << 10,
};
using Bits = std::uint32_t;
std::vector<std::string> bit_names(Bits bits);  // "shader_storage", ...

enum class Lifetime { state, scratch };  // scratch: written anew before it is read in every step

struct PlannedBuffer {
  std::string name;
  ElementType type = ElementType::float1;
  std::string domain, unit;
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;
  bool texture = false;
  int width = 0, height = 0;  // textures
  Lifetime lifetime = Lifetime::state;
  int storage = 0;                          // buffers with the same number share memory
  Place place;                              // of the stage that names it first
  std::vector<std::uint32_t> initial = {};  // its contents at the start; empty: zeros
};

struct BufferAccess {
  int buffer = 0;
  Access access = Access::read;
  Usage usage = Usage::storage;
  bool operator==(const BufferAccess&) const = default;
};

struct PlannedStage {
  std::string label;
  StageSpec spec;              // ports and work without those whose condition does not hold
  ParameterValues parameters;  // every parameter of the spec has a value
  std::vector<int> buffers;    // per port of `spec`; -1: optional and unbound
  std::int64_t every = 1;
  Place place;
};

struct Op;
struct Barrier {
  Bits bits = 0;
  std::vector<std::string> reasons;
};
struct GroupCounts {  // of a dispatch inside a repeat that ends on the device: three uint, all 0 once the end is reached
  int buffer = -1;    // -1: the dispatch always runs
  int slot = 0;       // from element 3 * slot
};
struct Run {  // one dispatch, draw or host call
  int stage = 0;
  int work = 0;  // index into the stage's work
  std::vector<BufferAccess> accesses;
  GroupCounts groups = {};
};
struct PlannedUntil {
  int buffer = 0;
  double below = 0;
  int progress = -1;  // buffer of the kernel that decides (repeats.h); -1: the host reads `buffer` after each turn, as transfer
};
struct Repeat {  // the body runs 1..max times; where the device decides, always max times, the last ones perhaps without groups
  std::int64_t max = 1;
  std::optional<PlannedUntil> until;
  std::vector<Op> body;
  Place place = {};
};
struct Op {
  std::variant<Barrier, Run, Repeat> what;
};

struct Plan {
  std::string pipeline, file;
  std::vector<PlannedStage> stages;
  std::vector<PlannedBuffer> buffers;
  std::vector<Op> setup, step, frame;
  Environment environment;
  std::uint64_t bytes = 0;  // of all storage

  [[nodiscard]] int buffer(const std::string& name) const;  // -1: none
};

}  // namespace firn::graph
