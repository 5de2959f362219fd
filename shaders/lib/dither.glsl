// A number in [0, 1) that depends on its arguments only (Jarzynski and Olano 2020: PCG).
float dither(uint a, uint b, uint c) {
  uint state = (a ^ (b * 2654435769u)) + c * 2246822519u;
  state = state * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return float(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}
