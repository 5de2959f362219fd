// Takes what every cell gives and adds what its neighbours give it, at their density [H 3.33]. A cell without snow takes the density of what
// arrives.
#include "heightfield/flatten_cell.glsl"
#include "lib/unbiased.glsl"

void main() {
  if (element_index() == 0u) moved[0] = uintBitsToFloat(moved_bits[0]);
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float given = outflow_at(i) * float(bitCount(outflow_to_at(i))), mass = 0.0, height = 0.0;
  for (int n = 0; n < 8; ++n) {
    ivec2 from = cell + neighbor_offsets[n];
    if (!in_field(from)) continue;
    int j = cell_index(from);
    float amount = outflow_at(j);
    if (amount > 0.0 && (outflow_to_at(j) >> uint(opposite_neighbor[n]) & 1u) != 0u) {
      mass += amount * density[j];  // a giver had snow, so that nobody changes its density now
      height += amount;
    }
  }
  if (given == 0.0 && height == 0.0) return;
  float before = depth[i];
  if (mass > 0.0 && !(before > 0.0)) density[i] = mass / height;
  float gained = mass > 0.0 ? mass / density[i] : 0.0;
  depth[i] = max(unbiased_sum(before, gained - given, i), 0.0);
#if CELLS_ACTIVE
  // A tile that gave is listed again, so that nobody ever takes an old outflow for a new one.
  if (given > 0.0) changed_tiles[tile_of(cell)] = 1u;
#endif
}
