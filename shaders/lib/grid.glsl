// Indices of the simulation grid. Nodes lie at grid_min + grid_cell (i, j, k); cell (i, j, k) has node (i, j, k) as its lowest corner, so
// nodes and cells share one numbering (the last cell of every axis is always empty).
// Needs the constants grid_min, grid_cell, grid_nodes.
#include "lib/finite.glsl"

int node_index(ivec3 node) { return node.x + grid_nodes.x * (node.y + grid_nodes.y * node.z); }

ivec3 node_of(uint index) {
  uint row = index / uint(grid_nodes.x);
  return ivec3(index - row * uint(grid_nodes.x), row % uint(grid_nodes.y), row / uint(grid_nodes.y));
}

vec3 node_position(ivec3 node) { return grid_min + grid_cell * vec3(node); }

vec3 grid_coordinates(vec3 position) { return (position - grid_min) / grid_cell; }

// Cells whose whole stencil lies on the grid: where particles may be. Clamping keeps indices in bounds even for NaN, which comparisons
// catch elsewhere.
bool inside_domain(vec3 position) {
  vec3 x = grid_coordinates(position);
  return all(greaterThanEqual(x, vec3(1.0))) && all(lessThan(x, vec3(grid_nodes - 2)));
}
ivec3 cell_of(vec3 position) { return clamp(ivec3(floor(grid_coordinates(position))), ivec3(1), grid_nodes - 3); }
