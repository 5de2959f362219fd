// Edges of the triangles, a little nearer than the surface, so that they lie on it.
void main() {
  gl_FragDepth = gl_FragCoord.z - 0.002 * (1.0 - gl_FragCoord.z);
  image = vec4(0.05, 0.12, 0.25, 1.0);
}
