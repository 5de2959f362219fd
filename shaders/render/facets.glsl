// Corners of the triangles of mesh bodies in the world. Needs lib/turn.glsl and the sampled ports facet_points, facet_body.

const vec4 nowhere = vec4(0.0, 0.0, 2.0, 1.0);  // beyond the far plane: a triangle that is not drawn

vec3 facet_corner(int body, int corner) {
  return body_position_at(body) + turned(body_orientation_at(body), facet_points_at(corner));
}
