#pragma once

// Particles that come while time passes. All of it is a function of the scene and of time alone: nothing is drawn from a state.

#include <cstdint>

#include "config/diagnostics.h"
#include "scene/sampling.h"

namespace firn::scene {

double particle_mass(const Scene& scene, const Emitter& emitter);         // kg, density cell^3 / per_cell
double particles_per_second(const Scene& scene, const Emitter& emitter);  // while it is on
double largest_speed(const Emitter& emitter);                             // m/s, as particles leave it

// How many particles have left the emitter by `time`: at every moment within half a particle of rate times time.
std::uint64_t emitted_until(const Scene& scene, const Emitter& emitter, double time);

// The particles `first` to `last` (not included) of scene.emitters[emitter], as they stand at `time` after they have left it one by
// one and have flown freely since. The same seed gives the same particles.
Particles emitted(const Scene& scene, std::size_t emitter, std::uint64_t first, std::uint64_t last, double time);

// Whether the declared maximum has room for the `particles` that the scene begins with (error), and for those that come until its
// end where nothing takes any away (warning).
void check_room(const Scene& scene, std::size_t particles, config::Diagnostics& diagnostics);

}  // namespace firn::scene
