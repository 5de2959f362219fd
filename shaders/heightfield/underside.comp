// The drawn map as arrays. Row 0 of the map is the smallest z, as it is of the arrays. Nothing drawn: depth 1, as it was cleared, and the
// map is void.
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  bool drawn = texelFetch(underside_depth, cell, 0).x < 1.0;
  vec2 seen = texelFetch(underside_map, cell, 0).xy;
  float height = drawn ? seen.x : infinity;
  int body = drawn ? int(seen.y) : -1;
#if HAS_CHANGED_TILES
  if (!(underside[i] == height) || owner[i] != body) changed_tiles[tile_of(cell)] = 1u;
#endif
  underside[i] = height;
  owner[i] = body;
}
