// How much of the sun reaches a place, from the shadow map. Needs shadow.glsl and the sampled port shadow_map, which may be left out.

#if HAS_SHADOW_MAP
// Four texels, those of the square of two by two about `corner`, in textureGather's order: how much light comes through to this depth.
// Behind what it met first, light goes on for `fade` of depth; 0: not at all.
vec4 light_through(vec2 corner, vec2 texel, float depth, float fade) {
  vec4 beyond = min(depth, 1.0) - textureGather(shadow_map, corner * texel);
  return fade > 0.0 ? exp(-max(beyond, 0.0) / fade) : vec4(lessThanEqual(beyond, vec4(0.0)));
}
#endif

// Width of the map's texels, m.
float shadow_texel() {
  vec3 extent = sun_extent(sun_axes());
  return 2.0 * max(extent.x / float(shadow_map_width), extent.y / float(shadow_map_height));
}

// Share of sunlight that arrives at x, over a square of 5 by 5 texels, without steps. `lift`: m toward the sun, against a surface's own
// shadow. `penetration`: m that light goes through snow until a third is left.
float sunlit(vec3 x, float lift, float penetration) {
#if HAS_SHADOW_MAP
  vec3 at = shadow_coordinates(x - lift * sun_direction);
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;
  float fade = penetration / (2.0 * sun_extent(sun_axes()).z);
  vec2 size = vec2(shadow_map_width, shadow_map_height);
  vec2 place = at.xy * size - 0.5;
  vec2 base = floor(place), f = place - base;
  // Texels base-2 .. base+3 per axis, weights 1-f, 1, 1, 1, 1, f.
  float sum = 0.0;
  for (int j = 0; j < 3; ++j) {
    vec2 wy = j == 0 ? vec2(1.0 - f.y, 1.0) : j == 1 ? vec2(1.0) : vec2(1.0, f.y);
    for (int i = 0; i < 3; ++i) {
      vec2 wx = i == 0 ? vec2(1.0 - f.x, 1.0) : i == 1 ? vec2(1.0) : vec2(1.0, f.x);
      vec4 light = light_through(base + vec2(2 * i - 1, 2 * j - 1), 1.0 / size, at.z, fade);
      sum += dot(light, vec4(wx.x * wy.y, wx.y * wy.y, wx.y * wy.x, wx.x * wy.x));
    }
  }
  return sum / 25.0;
#else
  return 1.0;
#endif
}
