#include "gpu/bindings.h"

#include <algorithm>

namespace firn::gpu {

namespace {

void forget(std::vector<std::uint32_t>& points, std::uint32_t id) { std::replace(points.begin(), points.end(), id, 0u); }
void forget(std::uint32_t& point, std::uint32_t id) {
  if (point == id) point = 0;
}

}  // namespace

void Bindings::forget_buffer(std::uint32_t id) {
  forget(storage, id);
  forget(uniform, id);
  forget(indirect, id);
  forget(edited, id);
}

void Bindings::forget_texture(std::uint32_t id) {
  forget(textures_2d, id);
  forget(textures_buffer, id);
  forget(images, id);
}

void Bindings::forget_program(std::uint32_t id) { forget(program, id); }

void Bindings::forget_framebuffer(std::uint32_t id) { forget(framebuffer, id); }

bool is_bound(const std::vector<std::uint32_t>& points, std::uint32_t point, std::uint32_t id) {
  return id != 0 && point < points.size() && points[point] == id;
}

void note_bound(std::vector<std::uint32_t>& points, std::uint32_t point, std::uint32_t id) {
  if (point >= points.size()) points.resize(point + 1, 0);
  points[point] = id;
}

}  // namespace firn::gpu
