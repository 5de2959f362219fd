// Where the nodes about a particle are stored, row by row along x. NODES_ALL: the whole grid. NODES_ACTIVE: in the block of the particle's
// cell and the seven below it; needs particle_cell, block_slot and block_near.
#include "lib/blocks.glsl"
#include "lib/bspline.glsl"

// Node i of a row is stored at low + i before `split`, at high + i from there on.
struct StencilRow {
  int low, high, split;
};
int stored_node(StencilRow row, int i) { return (i < row.split ? row.low : row.high) + i; }

struct Stencil {
  vec3 u;      // position minus lowest node, in cells
  ivec3 base;  // lowest node, on the grid; NODES_ACTIVE: from the lowest node of the block below
#if NODES_ACTIVE
  ivec4 low, high;  // slots of the eight blocks: low and high in x; components: low and high in y, then the same high in z
#endif
};

Stencil stencil_of(uint particle, vec3 position) {
  Stencil stencil;
  vec3 x = grid_coordinates(position);
  ivec3 base = clamp(stencil_base(x), ivec3(0), grid_nodes - stencil_width);
#if NODES_ACTIVE
  // The cell that the particle was sorted into is known by its place in the block alone, and that tells how far it has come since.
  uint cell = particle_cell[particle];
  ivec3 inside = ivec3(local_node(cell & 63u));
  ivec3 come = ((base - inside + 4) & 3) - 1;
  stencil.base = inside + 1 + come;
  ivec3 held = clamp(stencil.base, ivec3(0), ivec3(8 - stencil_width));
  base += held - stencil.base;
  stencil.base = held;
  int block = int(4u * block_slot[cell >> 6u]);
  stencil.low = block_near[block + 2];
  stencil.high = block_near[block + 3];
#else
  stencil.base = base;
#endif
  stencil.u = x - vec3(base);
  return stencil;
}

StencilRow stencil_row(Stencil stencil, int j, int k) {
  StencilRow row;
#if NODES_ACTIVE
  int y = stencil.base.y + j, z = stencil.base.z + k;
  int inside = 4 * (y & 3) + 16 * (z & 3) + stencil.base.x;
  ivec2 low = z < 4 ? stencil.low.xy : stencil.low.zw, high = z < 4 ? stencil.high.xy : stencil.high.zw;
  row.low = 64 * (y < 4 ? low.x : low.y) + inside;
  row.high = 64 * (y < 4 ? high.x : high.y) + inside - 4;
  row.split = 4 - stencil.base.x;
#else
  row.low = node_index(stencil.base + ivec3(0, j, k));
  row.high = row.low;
  row.split = 0;
#endif
  return row;
}
