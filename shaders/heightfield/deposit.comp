// S += arrived / rho [H 3.28]; a cell without snow takes the density of what arrives. Where that is not known, it takes the density that
// the cell has, or the lowest there is.
#include "lib/own_cell.glsl"
#include "lib/unbiased.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float mass = arrived[i];
  if (!(mass > 0.0)) return;
  float rho = density[i];
  if (!(depth[i] > 0.0)) {
#if HAS_ARRIVED_HEIGHT
    if (arrived_height[i] > 0.0) rho = clamp(mass / arrived_height[i], min_density, max_density);
#endif
    if (!(rho > 0.0)) rho = min_density;
    density[i] = rho;
  }
  depth[i] = unbiased_sum(depth[i], mass / rho, i);
#if HAS_CHANGED_TILES
  changed_tiles[tile_of(cell)] = 1u;
#endif
}
