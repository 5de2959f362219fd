// One element of 16 bytes read and written by every invocation, those of a work group side by side.
layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer From { vec4 from[]; };
layout(std430, binding = 1) writeonly buffer To { vec4 to[]; };

void main() {
  uint element = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (element < uint(to.length())) to[element] = from[element];
}
