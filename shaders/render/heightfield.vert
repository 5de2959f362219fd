// One vertex per patch: its number is all that it says. 15 patches in an instance, see stages/render/heightfield.cpp.
flat out int patch_number;

void main() {
  patch_number = 15 * gl_InstanceID + gl_VertexID;
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
