// The fixed-point scale of grid forces, from the largest entry of V0 tau in this step: a node's force component is at most
// (most particles in a cell) 3 max|V0 tau| (7/3) (5/3)^2 / h, since per axis sum N <= 5/3 and sum |N'| <= 7/3 over one particle per cell.
float force_scale(uint largest_stress_bits) {
  float bound = crowd * 3.0 * uintBitsToFloat(largest_stress_bits) * (7.0 / 3.0) * (25.0 / 9.0) / grid_cell;
  return bound > 0.0 ? exp2(clamp(floor(30.0 - log2(bound)), -100.0, 100.0)) : 1.0;
}
