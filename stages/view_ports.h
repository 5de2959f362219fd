#pragma once

// The pictures that drawing stages share, each declared once, and what they read of the scene's bodies.

#include "graph/spec.h"

namespace firn::stages::view {

graph::Port image(graph::Access access, graph::Usage usage);
graph::Port image_depth(graph::Access access);
graph::Port shadow_map(graph::Access access, graph::Usage usage);
// May be left out: then nothing lies in the shade of particles or bodies.
graph::Port optional_shadow_map();

// body_kind, body_size, body_position, body_orientation, sampled; all may be left out: then there are no bodies.
std::vector<graph::Port> optional_shapes();
// facet_points and facet_body, sampled: the triangles of meshes; both may be left out.
std::vector<graph::Port> optional_facets();
// A port of `mpm_ports.h`, sampled, that may be left out.
graph::Port optional(graph::Port port);

// Uses of shaders that read sampled ports by these names.
std::vector<graph::PortUse> sampled(std::initializer_list<const char*> names);

// The names of the constants that camera.glsl, shadow.glsl and light.glsl need.
std::vector<std::string> constants();

graph::ParameterSpec exposure_parameter();

}  // namespace firn::stages::view
