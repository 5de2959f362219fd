/*
firn: 1
name: wind_drift
doc: Wind carries the surface of the snow on to the next cells, and leaves it in the lee
equation: upwind scheme for the mass per area
ports:
  ground: {type: float, domain: cells, access: read, unit: m, doc: height of the ground}
  depth: {type: float, domain: cells, access: read, unit: m, doc: depth of the snow}
  density: {type: float, domain: cells, access: read, unit: kg/m3, doc: density of the snow}
  drifted_depth: {type: float, domain: cells, access: write, unit: m, doc: depth of the snow afterwards}
  drifted_density: {type: float, domain: cells, access: write, unit: kg/m3, doc: density of the snow afterwards}
parameters:
  wind: {kind: vector3, default: [1, 0, 0], min: -1, max: 1, doc: direction of the wind; only x and z count}
  erosion: {default: 0.5, min: 0, max: 1000, unit: kg/m2/s, doc: snow that the wind takes up where nothing shelters it}
  shelter: {default: 0.2, min: 1.0e-3, max: 10, unit: m/m, doc: slope down from the cell upwind at which the wind takes nothing any more}
constants: [field_cell]
over: cells
*/

// Keeps the mass: what a cell gives is what its neighbours downwind get, and nothing leaves the field. Keeps the volume too: snow
// travels at the density it had.
//
// A kernel must not write what its neighbours still read, so the result has arrays of its own. Used twice in a row, the second time
// with the ports the other way round, it ends where it began; each use does its own step of time.

#include "lib/cells.glsl"

ivec2 side(float along, ivec2 axis) { return along > 0.0 ? axis : along < 0.0 ? -axis : ivec2(0); }
float height(ivec2 cell) { return ground[cell_index(cell)] + depth[cell_index(cell)]; }

// Mass per area that the wind carries from the cell to its neighbour at `step_to`, which is one of the two downwind.
float given(ivec2 cell, ivec2 step_to, float share) {
  if (share == 0.0 || !in_field(cell) || !in_field(cell + step_to)) return 0.0;
  ivec2 upwind = cell - step_to;
  float below = in_field(upwind) ? (height(upwind) - height(cell)) / field_cell : 0.0;
  float exposed = clamp(1.0 - below / shelter, 0.0, 1.0);
  int index = cell_index(cell);
  return share * min(erosion * exposed * dt, depth[index] * density[index]);
}

void main() {
  uint number = element_index();
  if (number >= cells_count) return;
  ivec2 cell = cell_at(number);
  float total = abs(wind.x) + abs(wind.z);
  vec2 share = total > 0.0 ? abs(wind.xz) / total : vec2(0.0);
  ivec2 along[2] = ivec2[2](side(wind.x, ivec2(1, 0)), side(wind.z, ivec2(0, 1)));

  float mass = depth[number] * density[number];
  float volume = depth[number];
  for (int axis = 0; axis < 2; ++axis) {
    float out_mass = given(cell, along[axis], share[axis]);
    mass -= out_mass;
    volume -= out_mass > 0.0 ? out_mass / density[number] : 0.0;
    ivec2 upwind = cell - along[axis];
    float in_mass = given(upwind, along[axis], share[axis]);
    mass += in_mass;
    volume += in_mass > 0.0 ? in_mass / density[cell_index(upwind)] : 0.0;
  }
  // The subtractions may leave a rounding error of snow where there is none any more.
  bool snow = volume > 0.0 && mass > 0.0;
  drifted_depth[number] = snow ? volume : 0.0;
  drifted_density[number] = snow ? mass / volume : density[number];
}
