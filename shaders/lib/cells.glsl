// Cells of the height field: (column along x, row along z).
#include "lib/cell_tiles.glsl"
#include "lib/divide.glsl"

const float infinity = uintBitsToFloat(0x7f800000u);

// left, right, down, up (-x, +x, -z, +z), then the diagonals
const ivec2 neighbor_offsets[8] = ivec2[8](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1), ivec2(-1, -1), ivec2(1, -1), ivec2(-1, 1), ivec2(1, 1));
// in that list, the way back
const int opposite_neighbor[8] = int[8](1, 0, 3, 2, 7, 6, 5, 4);

// Written out: an index into a constant list that is not known beforehand is slow.
#define FOR_NEIGHBORS(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)

int cell_index(ivec2 cell) { return cell.y * cells_width + cell.x; }
ivec2 cell_at(uint index) { return divided(int(index), cells_width); }
bool in_field(ivec2 cell) { return all(greaterThanEqual(cell, ivec2(0))) && cell.x < cells_width && cell.y < cells_height; }

ivec2 tile_counts() { return (ivec2(cells_width, cells_height) + tile_edge - 1) / tile_edge; }
uint tile_of(ivec2 cell) {
  ivec2 tile = cell / tile_edge;
  return uint(tile.y * tile_counts().x + tile.x);
}
// One group of 256 per tile.
ivec2 tile_cell(uint tile) {
  int local = int(gl_LocalInvocationID.x);
  return tile_edge * divided(int(tile), tile_counts().x) + ivec2(local % tile_edge, local / tile_edge);
}
