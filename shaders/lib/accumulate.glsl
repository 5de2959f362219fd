// Adding to `accumulate` ports, which many invocations do at once. Two ways (ACCUMULATE_FIXED, ACCUMULATE_FLOAT):
//   fixed  integers of value * scale: the order does not matter, so results repeat to the bit. An overflow is a fault.
//   float  float atomics where the device has them, else a compare-and-swap loop. The last bits depend on the order.
// Macros, since GLSL functions cannot take buffers.

#if ACCUMULATE_FIXED

#include "lib/dither.glsl"

// Rounded up or down by a repeatable throw of the dice, so that sums are right on average: to the nearest, the many contributions below half
// a step would all be lost, and with them momentum. Held within what an int has; a NaN counts as overflow.
int fixed_point(float value, float scale, int index) {
  float scaled = value * scale;
  if (!(abs(scaled) < 2147483520.0)) {
    fault(FAULT_OVERFLOW);
    return 0;
  }
  float whole = floor(scaled);
  return int(whole) + (dither(floatBitsToUint(value), uint(index), step) < scaled - whole ? 1 : 0);
}

void check_sum(int before, int added) {
  int sum = before + added;
  if (((before ^ sum) & (added ^ sum)) < 0) fault(FAULT_OVERFLOW);
}

#define ACCUMULATE(name, index, value, scale)           \
  {                                                     \
    int added_ = fixed_point(value, scale, index);      \
    check_sum(atomicAdd(name[index], added_), added_);  \
  }

#elif FIRN_FLOAT_ATOMICS

#define ACCUMULATE(name, index, value, scale) { atomicAdd(name[index], value); }

#else

#define ACCUMULATE(name, index, value, scale)                                                        \
  {                                                                                                  \
    uint expected_ = name[index];                                                                    \
    for (;;) {                                                                                       \
      uint wanted_ = floatBitsToUint(uintBitsToFloat(expected_) + (value));                          \
      uint seen_ = atomicCompSwap(name[index], expected_, wanted_);                                  \
      if (seen_ == expected_) break;                                                                 \
      expected_ = seen_;                                                                             \
    }                                                                                                \
  }

#endif
