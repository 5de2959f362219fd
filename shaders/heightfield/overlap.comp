// D [H 3.2, 3.4]: a body may reach below the ground, but not further than through all of the snow.
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float below = underside[i];
  overlap[i] = below < infinity ? clamp(ground[i] + depth[i] - below, 0.0, depth[i]) : 0.0;
}
