// One pass over the addends of lib/body_sums.glsl: NOTING how many there are and how large, or ADDING them. An invocation goes through its
// column once for each body that has a part in it and keeps the sums to itself until then: memory that all cells add to is what costs.
// Before including: lowest_body(i), the smallest number of a body that cell i may give to, uint(-1) for none, and
// cell_addends(cell, i, bodies, values), the body (-1: none) and the addend for each of the four slots.
#include "lib/body_sums.glsl"

#define SLOTS(DO) DO(0) DO(1) DO(2) DO(3)

void main() {
  ivec2 first;
  if (!own_column(first)) return;
  uint body = uint(-1);
  int up = 0;
  do {
    ivec2 cell = first + ivec2(0, up);
    if (in_field(cell)) body = min(body, lowest_body(cell_index(cell)));
  } while (++up < column_cells);
  do {
    uint next = uint(-1);
#ifdef NOTING
    vec4 peaks = vec4(0.0);
    uvec4 counts = uvec4(0u);
#define COLLECT(slot)                                   \
  peaks[slot] = max(peaks[slot], abs(values[slot]));    \
  counts[slot] += 1u;
#define GIVE(slot)                                                             \
  if (counts[slot] > 0u) {                                                     \
    atomicMax(SUM_PEAKS[4u * body + slot], floatBitsToUint(peaks[slot]));      \
    atomicAdd(SUM_COUNTS[4u * body + slot], counts[slot]);                     \
  }
#else
    // Whole steps of the upper word, and of the lower one what is left. Multiplying by powers of two rounds nothing.
    uvec4 upper = uvec4(0u), lower = uvec4(0u);
    vec4 smaller, steps, rest_steps;
#define MEASURE(slot)                                          \
  {                                                            \
    int at = 4 * int(min(body, bodies_count - 1u)) + slot;     \
    int bits = spare_bits(at);                                 \
    smaller[slot] = 1.0 / sum_unit(at);                        \
    steps[slot] = ldexp(1.0, 31 - bits);                       \
    rest_steps[slot] = ldexp(1.0, 32 - bits);                  \
  }
    SLOTS(MEASURE)
#define COLLECT(slot)                                               \
  float value = values[slot] * smaller[slot] * steps[slot];         \
  upper[slot] += uint(int(floor(value)));                           \
  lower[slot] += uint((value - floor(value)) * rest_steps[slot]);
#define GIVE(slot)                                                      \
  if ((upper[slot] | lower[slot]) != 0u) {                              \
    atomicAdd(SUM_WORDS[8u * body + 2u * slot], upper[slot]);           \
    atomicAdd(SUM_WORDS[8u * body + 2u * slot + 1u], lower[slot]);      \
  }
#endif
    up = 0;
    do {
      ivec2 cell = first + ivec2(0, up);
      if (in_field(cell)) {
        ivec4 bodies;
        vec4 values;
        cell_addends(cell, cell_index(cell), bodies, values);
#define TAKE(slot)                                          \
  if (uint(bodies[slot]) == body) {                         \
    COLLECT(slot)                                           \
  } else if (uint(bodies[slot]) > body) {                   \
    next = min(next, uint(bodies[slot]));                   \
  }
        SLOTS(TAKE)
      }
    } while (++up < column_cells);
    if (body < bodies_count) {
      SLOTS(GIVE)
    }
    body = next;
  } while (body < bodies_count);
}
