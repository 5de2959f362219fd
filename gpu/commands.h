#pragma once

// The OpenGL commands that an executor issues. Bindings are remembered, so that binding what is bound already costs no GL call
// (forget_bindings() after anything else touched the state). Nothing here waits, save where said. Errors: see Device::check().

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gpu/program.h"
#include "gpu/resources.h"

namespace firn::gpu {

// Bits of glMemoryBarrier, by how data is accessed after it.
enum class BarrierBit : std::uint32_t {
  vertex_attrib_array = 1u << 0,
  element_array = 1u << 1,
  uniform = 1u << 2,
  texture_fetch = 1u << 3,
  shader_image_access = 1u << 4,
  command = 1u << 5,
  pixel_buffer = 1u << 6,
  texture_update = 1u << 7,
  buffer_update = 1u << 8,
  framebuffer = 1u << 9,
  shader_storage = 1u << 10,
};
void memory_barrier(std::uint32_t bits);  // any union of BarrierBit
void memory_barrier_all();

void use(const Program& program);
void bind_storage(std::uint32_t binding, const Buffer& buffer);
void bind_uniform(std::uint32_t binding, const Buffer& buffer);
void bind_texture(std::uint32_t unit, const BufferTexture& texture);
void bind_texture(std::uint32_t unit, const Texture& texture);  // nearest, clamped to the edge
void bind_image(std::uint32_t unit, const Texture& texture);    // read and write, the texture's own format
void bind_indirect(const Buffer& buffer);
void forget_bindings();

void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z);
void dispatch_indirect(std::uint64_t offset);  // three uint of the bound indirect buffer

void copy(const Buffer& from, const Buffer& to, std::uint64_t bytes);  // glCopyBufferSubData, from the start of each

enum class Topology { points, lines, triangles, triangle_strip, patches };
enum class DepthTest { off, less, less_equal, always };
enum class Blend { off, alpha, additive, minimum, maximum };
struct DrawState {
  Topology topology = Topology::triangles;
  int patch_vertices = 4;
  DepthTest depth_test = DepthTest::off;
  bool depth_write = false;  // only with a depth test, as in OpenGL: `always` writes untested
  Blend blend = Blend::off;
  bool wireframe = false;
  bool cull_back = false;
};
// No vertex attributes: vertex shaders fetch from buffers by gl_VertexID and gl_InstanceID.
void draw(const Framebuffer& target, const DrawState& state, std::uint32_t vertices, std::uint32_t instances);
// Draws the least there is, one primitive, and keeps all of it out of the target: only so that a driver which makes machine code at
// the first draw makes it now. Vertex shaders run.
void rehearse_draw(const Framebuffer& target, const DrawState& state);
// An integer attachment takes the values as integers.
void clear_color(const Framebuffer& target, int attachment, float r, float g, float b, float a);
void clear_depth(const Framebuffer& target, float depth);

// GPU time stamps in a ring, read late: begin/end cost a query each, collect() takes only those that are ready unless `wait`.
class TimerRing {
 public:
  explicit TimerRing(int slots);
  ~TimerRing();
  TimerRing(const TimerRing&) = delete;
  TimerRing& operator=(const TimerRing&) = delete;

  struct Sample {
    std::int64_t tag = 0;
    double start = 0;  // s since the ring was made
    double seconds = 0;
  };
  // Marks the start and the end of one piece of work. A full ring collects (waiting) before it goes on.
  void begin(std::int64_t tag);
  void end();
  std::vector<Sample> collect(bool wait);

 private:
  struct Slot {
    std::uint32_t start = 0, stop = 0;
    std::int64_t tag = 0;
  };
  void take_finished(bool wait);

  std::vector<Slot> slots_;
  std::uint64_t made_ = 0;           // the device's time, ns
  std::size_t head_ = 0, tail_ = 0;  // numbers of the next slot to begin and the oldest not taken
  bool running_ = false;             // between begin() and end()
  std::vector<Sample> done_;
};

}  // namespace firn::gpu
