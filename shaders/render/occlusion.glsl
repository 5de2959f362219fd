// Shade of the sky by rigid bodies. Needs shapes.glsl.

// How much of the sky bodies leave open over a place with this normal.
float sky_left_by_bodies(vec3 x, vec3 normal, int itself) {
  float open = 1.0;
  for (int b = 0; b < int(bodies_count); ++b) {
    int kind = body_kind_at(b);
    if (kind == 0 || b == itself) continue;
    vec3 size = body_size_at(b).xyz;
    float reach = kind == 2 || kind == 4 ? max(size.x, max(size.y, size.z)) : size.x;
    float far_off = length(body_position_at(b) - x) - bounding_radius(kind, size);
    if (far_off > 6.0 * reach) continue;  // less than 1/300
    vec4 toward = toward_solid(b, kind, x);
    float share = reach / (reach + max(toward.w, 0.0));  // as large as a ball of this radius looks from there
    open *= 1.0 - clamp(0.2 + 0.8 * dot(toward.xyz, normal), 0.0, 1.0) * share * share * share;
  }
  return open;
}
