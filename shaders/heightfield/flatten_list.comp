// Tiles where something changed.
#include "heightfield/flatten_list.glsl"

void main() {
  uint tile = element_index();
  if (tile >= tiles_count || changed_tiles[tile] == 0u) return;
  changed_tiles[tile] = tile_listed;
  list_tile(tile);
}
