// The sun's view of the scene: parallel rays, fitted to the box scene_min .. scene_max.
// Shadow coordinates: x and y in 0..1 across the map, z the depth along the rays in 0..1.
// Needs the constants sun_direction, scene_min, scene_max.

// Columns: across, across, along the rays.
mat3 sun_axes() {
  vec3 other = abs(sun_direction.y) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 across = normalize(cross(sun_direction, other));
  return mat3(across, cross(sun_direction, across), sun_direction);
}

// Half the extent of the box along the sun's axes, a little more than needed.
vec3 sun_extent(mat3 axes) {
  vec3 h = 0.5 * (scene_max - scene_min);
  return 1.02 * vec3(dot(abs(axes[0]), h), dot(abs(axes[1]), h), dot(abs(axes[2]), h)) + 1.0e-3;
}

vec3 shadow_coordinates(vec3 x) {
  mat3 axes = sun_axes();
  return 0.5 + 0.5 * (transpose(axes) * (x - 0.5 * (scene_min + scene_max))) / sun_extent(axes);
}
