// Sets the grid's accumulators to zero.
void main() {
  uint node = element_index();
  if (node >= nodes_count) return;
#if ACCUMULATE_FIXED
  grid_mass_sum[node] = 0;
  grid_momentum_sum[node] = ivec3(0);
  grid_force_sum[node] = ivec3(0);
  if (node == 0u) stress_max[0] = 0u;
#else
  grid_mass_sum[node] = 0.0;
  grid_momentum_sum[node] = vec3(0.0);
  grid_force_sum[node] = vec3(0.0);
#endif
}
