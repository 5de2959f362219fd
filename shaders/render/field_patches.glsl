// The height field as patches: `patches` by `patches` over the field and a ring of patches round it, which carries the field's edge
// outward as snow to the horizon, or down as the sides of a block.
// Grid coordinates g: 0 .. patches over the field, -1 .. 0 and patches .. patches + 1 in the ring.
// Needs field_heights.glsl, the constants field_min, field_cell, camera_from, scene_min and the parameters patches, factor, near, range.

const float ring_reach = 40.0;  // of the field's extent: beyond, all is haze

int patch_side() { return patches + 2; }
ivec2 patch_at(int index) { return ivec2(index % patch_side(), index / patch_side()) - 1; }
bool in_ring(ivec2 at) { return any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(patches))); }

vec2 field_extent() { return field_cell * vec2(cells_width, cells_height); }
float field_bottom() { return scene_min.y - 0.01 * max(field_extent().x, field_extent().y); }

// Where a point of the grid lies. Points that neighbouring patches share are computed alike, to the bit.
vec3 patch_point(vec2 g) {
  vec2 inside = clamp(g, vec2(0.0), vec2(float(patches)));
  vec2 beyond = g - inside;
  vec2 place = field_min.xz + field_extent() * (inside / float(patches));
  float height = field_height_near(place);
#if SURROUNDINGS_SNOW
  place += beyond * beyond * beyond * ring_reach * field_extent();
#else
  height = mix(height, field_bottom(), max(abs(beyond.x), abs(beyond.y)));
#endif
  return vec3(place.x, height, place.y);
}

// [H 4.9]: the same for both patches that share the edge, as it knows nothing but the edge's ends.
float edge_factor(vec3 p1, vec3 p2) {
#if TESSELLATION_DISTANCE
  float away = length(0.5 * (p1 + p2) - camera_from);
  return min(factor * (1.0 - clamp((away - near) / range, 0.0, 1.0)) + 1.0, 64.0);
#else
  return factor;
#endif
}

// Factors in OpenGL's order: the edges u = 0, v = 0, u = 1, v = 1, where p10 is the corner at u = 1, v = 0.
vec4 patch_edges(vec3 p00, vec3 p10, vec3 p01, vec3 p11) {
  return vec4(edge_factor(p00, p01), edge_factor(p00, p10), edge_factor(p10, p11), edge_factor(p01, p11));
}
