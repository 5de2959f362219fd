/*
firn: 1
name: velocity_damping
doc: Slows particles down, as thin air would
equation: dv/dt = -rate v, solved exactly over the step
ports:
  velocity: {type: vec3, domain: particles, access: read_write, unit: m/s, doc: velocity of the particle}
parameters:
  rate: {default: 1, min: 0, max: 1000, unit: 1/s, doc: share of the speed that is lost per second}
over: particles
*/

// Mass stays as it is; momentum falls with exp(-rate t).
void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  velocity[particle] *= exp(-rate * dt);
}
