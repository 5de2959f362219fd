// a + b, rounded up or down by a repeatable throw of the dice with the chances that make the sum right on average. To the nearest, the
// many small amounts below half a step of a large one would all be lost on one side, and with them mass.
#include "lib/dither.glsl"

float unbiased_sum(float a, float b, int index) {
  precise float sum = a + b;
  precise float virtual_b = sum - a;
  precise float error = (a - (sum - virtual_b)) + (b - virtual_b);  // exact (Knuth's TwoSum)
  if (error == 0.0 || sum == 0.0) return sum;
  bool away = (error > 0.0) == (sum > 0.0);
  precise float next = uintBitsToFloat(floatBitsToUint(sum) + (away ? 1u : 0xffffffffu));
  return dither(floatBitsToUint(sum), uint(index), step) * abs(next - sum) < abs(error) ? next : sum;
}
