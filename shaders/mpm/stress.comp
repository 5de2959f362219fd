// V_p0 P(FE) FE^T of every particle [M 26, 29-32], in J.
#include "lib/material.glsl"

void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  vec2 lame = hardened_lame(material_elastic[material[particle]], plastic_det[particle]);
  mat3 value = volume[particle] * kirchhoff_stress(elastic[particle], lame);
  stress[particle] = value;
#if ACCUMULATE_FIXED
  vec3 largest = max(max(abs(value[0]), abs(value[1])), abs(value[2]));
  float top = max(largest.x, max(largest.y, largest.z));
  if (!(top < 3.0e38)) {
    fault(FAULT_NOT_A_NUMBER);
    return;
  }
  atomicMax(stress_max[0], floatBitsToUint(top));  // order of non-negative floats is that of their bits
#endif
}
