layout(vertices = 4) out;

void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = 2.0;
  for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = 2.0;
}
