// Takes what every cell gives and adds what its neighbours give it, at their density [H 3.33]. A cell without snow takes the density of what
// arrives.
#include "heightfield/flatten_cell.glsl"
#include "lib/unbiased.glsl"

// What the neighbour `from` gives to this cell, whose number among the neighbours of `from` is `back`: mass and height.
vec2 taken(ivec2 from, int back) {
  if (!in_field(from)) return vec2(0.0);
  int j = cell_index(from);
  vec2 gives = outflow_at(j);
  if ((int(gives.y) >> back & 1) == 0) return vec2(0.0);
  return gives.x * vec2(density[j], 1.0);  // a giver had snow, so that nobody changes its density now
}

void main() {
  if (element_index() == 0u) moved[0] = uintBitsToFloat(moved_bits[0]);
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  vec2 own = outflow_at(i);
  float given = own.x * float(bitCount(int(own.y)));
  vec2 arrived = vec2(0.0);  // mass, height
#define TAKE(n) arrived += taken(cell + neighbor_offsets[n], opposite_neighbor[n]);
  FOR_NEIGHBORS(TAKE)
  if (given == 0.0 && arrived.y == 0.0) return;
  float before = depth[i];
  if (arrived.x > 0.0 && !(before > 0.0)) density[i] = arrived.x / arrived.y;
  float gained = arrived.x > 0.0 ? arrived.x / density[i] : 0.0;
  depth[i] = max(unbiased_sum(before, gained - given, i), 0.0);
#if CELLS_ACTIVE
  // A tile that gave is listed again, so that nobody ever takes an old outflow for a new one.
  if (given > 0.0) changed_tiles[tile_of(cell)] = 1u;
#endif
}
