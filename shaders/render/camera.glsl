// The scene's camera. y is up. Needs the constants camera_from, camera_to, camera_fov and a port of the domain image.

const float near_plane = 0.02;  // m
const float no_depth = 1.0;     // what the depth is cleared to: nothing there

// Columns: right, up, forward.
mat3 camera_axes() {
  vec3 forward = normalize(camera_to - camera_from);
  vec3 above = abs(forward.y) > 0.9999 ? vec3(0.0, 0.0, -1.0) : vec3(0.0, 1.0, 0.0);
  vec3 right = normalize(cross(forward, above));
  return mat3(right, cross(right, forward), forward);
}

// Half the picture's extent at distance 1.
vec2 picture_slope() {
  float up = tan(radians(0.5 * camera_fov));
  return vec2(up * float(image_width) / float(image_height), up);
}
// Width of a pixel at distance 1.
float pixel_angle() { return 2.0 * tan(radians(0.5 * camera_fov)) / float(image_height); }

// Unit vector from the camera through a place in the picture, in pixels from the lower left corner.
vec3 camera_ray(vec2 pixel) {
  vec2 at = (2.0 * pixel / vec2(image_width, image_height) - 1.0) * picture_slope();
  return normalize(camera_axes() * vec3(at, 1.0));
}

// Depth without a far plane: 0 at the near plane, 1 at infinity.
float depth_at(float forward) { return 1.0 - near_plane / max(forward, near_plane); }

vec4 clip_position(vec3 position) {
  vec3 seen = transpose(camera_axes()) * (position - camera_from);
  return vec4(seen.xy / picture_slope(), seen.z - 2.0 * near_plane, seen.z);
}
