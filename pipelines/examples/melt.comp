/*
firn: 1
name: melt
doc: Melts snow by the temperature of the air, which falls with height
equation: degree-day method, melt = factor max(T, 0)
ports:
  ground: {type: float, domain: cells, access: read, unit: m, doc: height of the ground}
  depth: {type: float, domain: cells, access: read_write, unit: m, doc: depth of the snow}
  density: {type: float, domain: cells, access: read, unit: kg/m3, doc: density of the snow}
  melted: {type: float, domain: cells, access: read_write, unit: kg/m2, doc: water that has run off since the start, optional: true}
parameters:
  temperature: {default: 5, min: -60, max: 60, unit: degC, doc: air at height 0}
  lapse: {default: 6.5e-3, min: 0, max: 1, unit: K/m, doc: how much colder the air gets with height}
  factor: {default: 4, min: 0, max: 100, unit: kg/m2/K/day, doc: snow that melts per day and degree above freezing}
  pace: {default: 1, min: 0, max: 1.0e6, doc: seconds of weather per second of simulation}
over: cells
*/

// Takes mass away: what melts runs off at once, and `melted` counts it, so that snow and water together keep their mass. The snow
// that is left keeps its density.
void main() {
  uint cell = element_index();
  if (cell >= cells_count) return;
  const float seconds_per_day = 86400.0;
  float air = temperature - lapse * (ground[cell] + depth[cell]);
  float wanted = factor * max(air, 0.0) * pace * dt / seconds_per_day;
  float there = depth[cell] * density[cell];
  float lost = min(wanted, there);
  depth[cell] = lost < there ? depth[cell] - lost / density[cell] : 0.0;
#if HAS_MELTED
  melted[cell] += lost;
#endif
}
