// The largest |v_p| + c_p, c the speed of pressure waves in the hardened material: sqrt((lambda + 2 mu) / rho).
void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  vec4 parameters = material_elastic[material[particle]];
  float hardening = exp(parameters.z * (1.0 - plastic_det[particle]));
  float sound = sqrt(hardening * (parameters.y + 2.0 * parameters.x) / parameters.w);
  atomicMax(fastest[0], floatBitsToUint(length(velocity[particle]) + sound));
}
