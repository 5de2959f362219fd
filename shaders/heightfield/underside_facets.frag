#include "heightfield/underside_fragment.glsl"
#include "heightfield/triangle_height.glsl"

flat in int body;
flat in vec3 a, b, c;

void main() { show(triangle_height(a, b, c, cell_center()), body); }
