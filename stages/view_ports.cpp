#include "stages/view_ports.h"

#include <utility>

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::view {

using graph::Access;
using graph::ElementType;
using graph::Port;
using graph::Usage;

Port image(Access access, Usage usage) {
  return {.name = "image",
          .type = ElementType::rgba8,
          .domain = "image",
          .access = access,
          .usage = usage,
          .unit = "1",
          .doc = "the picture, sRGB, row 0 at the bottom"};
}

Port image_depth(Access access) {
  return {.name = "image_depth",
          .type = ElementType::depth,
          .domain = "image",
          .access = access,
          .usage = Usage::framebuffer,
          .unit = "1",
          .doc = "1 - near / distance along the camera's axis"};
}

Port shadow_map(Access access, Usage usage) {
  return {.name = "shadow_map",
          .type = ElementType::depth,
          .domain = "shadow_map",
          .access = access,
          .usage = usage,
          .unit = "1",
          .doc = "how far sunlight comes, from 0 to 1 across the scene's box; 1: through"};
}

Port optional_shadow_map() { return optional(shadow_map(Access::read, Usage::sampled)); }

std::vector<Port> optional_shapes() {
  std::vector<Port> ports;
  for (const char* name : {"body_kind", "body_size", "body_position", "body_orientation"})
    ports.push_back(optional(mpm::body(name, Access::read)));
  return ports;
}

std::vector<Port> optional_facets() {
  return {optional(heightfield::port("facet_points", Access::read)), optional(heightfield::port("facet_body", Access::read))};
}

Port optional(Port port) {
  port.usage = Usage::sampled;
  return mpm::optional(std::move(port));
}

std::vector<graph::PortUse> sampled(std::initializer_list<const char*> names) {
  std::vector<graph::PortUse> uses;
  for (const char* name : names) uses.push_back({name, Access::read, Usage::sampled});
  return uses;
}

std::vector<std::string> constants() {
  return {"camera_from", "camera_to", "camera_fov", "sun_direction", "scene_min", "scene_max"};
}

graph::ParameterSpec exposure_parameter() {
  return {.name = "exposure",
          .kind = graph::ParameterKind::number,
          .initial = 1.0,
          .min = 0.01,
          .max = 100.0,
          .unit = "1",
          .doc = "brightness of the picture; the same in all drawing stages"};
}

}  // namespace firn::stages::view
