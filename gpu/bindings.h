#pragma once

// Inside gpu/ only: what is bound in a context, so that binding it again costs nothing.

#include <cstdint>
#include <vector>

namespace firn::gpu {

// Ids of OpenGL objects, 0 where nothing is known to be bound. The vectors grow with the binding points used.
// OpenGL gives the id of a deleted object to the next one made, so whoever deletes an object calls the `forget_` of its kind.
struct Bindings {
  std::uint32_t program = 0;
  std::vector<std::uint32_t> storage, uniform;              // buffers
  std::vector<std::uint32_t> textures_2d, textures_buffer;  // by texture unit
  std::vector<std::uint32_t> images;                        // by image unit
  std::uint32_t indirect = 0;
  std::uint32_t edited = 0;  // the buffer bound where buffers are changed
  std::uint32_t framebuffer = 0;
  bool draw_state_known = false;
  std::uint64_t draw_state = 0;  // DrawState, packed
  int viewport_width = 0, viewport_height = 0, patch_vertices = 0;

  void forget_buffer(std::uint32_t id);
  void forget_texture(std::uint32_t id);
  void forget_program(std::uint32_t id);
  void forget_framebuffer(std::uint32_t id);
};

// Whether `id` is known to be bound at `point`.
bool is_bound(const std::vector<std::uint32_t>& points, std::uint32_t point, std::uint32_t id);
// To be called once OpenGL has accepted the binding: `point` is within its limits then.
void note_bound(std::vector<std::uint32_t>& points, std::uint32_t point, std::uint32_t id);

}  // namespace firn::gpu
