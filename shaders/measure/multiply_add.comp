// TURNS times CHAINS multiply-adds of four floats by every invocation, chains that do not wait for each other. The factors come
// from memory, so that nothing is known when it is compiled, and keep the values finite: x <- x / 2 + 1.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Factors { vec4 factors[]; };
layout(std430, binding = 1) writeonly buffer Sums { vec4 sums[]; };

void main() {
  vec4 factor = factors[0], addend = factors[1];
  vec4 value[CHAINS];
  for (int chain = 0; chain < CHAINS; ++chain) value[chain] = factor * float(chain) + vec4(gl_GlobalInvocationID.x);
  for (int turn = 0; turn < TURNS; ++turn)
    for (int chain = 0; chain < CHAINS; ++chain) value[chain] = value[chain] * factor + addend;
  vec4 sum = vec4(0);
  for (int chain = 0; chain < CHAINS; ++chain) sum += value[chain];
  sums[gl_GlobalInvocationID.x] = sum;
}
