#include "stages/register.h"

#include "stages/bodies/integrate.h"
#include "stages/bodies/place.h"
#include "stages/heightfield/active_tiles.h"
#include "stages/heightfield/compress.h"
#include "stages/heightfield/contour.h"
#include "stages/heightfield/deposit.h"
#include "stages/heightfield/distance_transform.h"
#include "stages/heightfield/distribute_contour.h"
#include "stages/heightfield/distribute_distance.h"
#include "stages/heightfield/flatten.h"
#include "stages/heightfield/init.h"
#include "stages/heightfield/overlap.h"
#include "stages/heightfield/resistance.h"
#include "stages/heightfield/support.h"
#include "stages/heightfield/underside.h"
#include "stages/io/bodies.h"
#include "stages/io/frames.h"
#include "stages/io/grid.h"
#include "stages/io/heightfield.h"
#include "stages/io/particles.h"
#include "stages/io/surface.h"
#include "stages/io/video.h"
#include "stages/mpm/advect.h"
#include "stages/mpm/clear_grid.h"
#include "stages/mpm/deform.h"
#include "stages/mpm/deform_stress.h"
#include "stages/mpm/emit.h"
#include "stages/mpm/gather_affine.h"
#include "stages/mpm/gather_to_grid.h"
#include "stages/mpm/gather_velocities.h"
#include "stages/mpm/grid_collide.h"
#include "stages/mpm/grid_forces.h"
#include "stages/mpm/grid_to_particles.h"
#include "stages/mpm/grid_to_particles_affine.h"
#include "stages/mpm/grid_update.h"
#include "stages/mpm/initial_density.h"
#include "stages/mpm/particle_collide.h"
#include "stages/mpm/particles_to_grid.h"
#include "stages/mpm/remove.h"
#include "stages/mpm/seed.h"
#include "stages/mpm/sort.h"
#include "stages/mpm/stress.h"
#include "stages/mpm/time_step.h"
#include "stages/render/background.h"
#include "stages/render/heightfield.h"
#include "stages/render/particles.h"
#include "stages/render/shadow_map.h"
#include "stages/render/surface.h"

namespace firn::stages {

graph::Registry all_stages(const std::shared_ptr<const Problem>& problem) {
  graph::Registry registry;
  const Exports exports{problem, std::make_shared<Writer>()};
  registry.add(bodies::integrate());
  registry.add(bodies::place(), bodies::placing(problem));
  registry.add(heightfield::active_tiles());
  registry.add(heightfield::compress());
  registry.add(heightfield::contour());
  registry.add(heightfield::deposit());
  registry.add(heightfield::distance_transform());
  registry.add(heightfield::distribute_contour());
  registry.add(heightfield::distribute_distance());
  registry.add(heightfield::flatten());
  registry.add(heightfield::init(), heightfield::initialising(problem));
  registry.add(heightfield::overlap());
  registry.add(heightfield::resistance());
  registry.add(heightfield::support());
  registry.add(heightfield::underside());
  registry.add(io::bodies(), io::writing_bodies(exports));
  registry.add(io::frames(), io::writing_frames(exports));
  registry.add(io::grid(), io::writing_grid(exports));
  registry.add(io::heightfield_files(), io::writing_heightfield(exports));
  registry.add(io::particles(), io::writing_particles(exports));
  registry.add(io::surface(), io::writing_surface(exports));
  registry.add(io::video(), io::writing_video(problem));
  registry.add(mpm::advect());
  registry.add(mpm::clear_grid());
  registry.add(mpm::deform());
  registry.add(mpm::deform_stress());
  registry.add(mpm::emit(), mpm::emitting(problem));
  registry.add(mpm::gather_affine());
  registry.add(mpm::gather_to_grid());
  registry.add(mpm::gather_velocities());
  registry.add(mpm::grid_collide());
  registry.add(mpm::grid_forces());
  registry.add(mpm::grid_to_particles());
  registry.add(mpm::grid_to_particles_affine());
  registry.add(mpm::grid_update());
  registry.add(mpm::initial_density());
  registry.add(mpm::particle_collide());
  registry.add(mpm::particles_to_grid());
  registry.add(mpm::remove(), mpm::removing(problem));
  registry.add(mpm::seed(), mpm::seeding(problem));
  registry.add(mpm::sort());
  registry.add(mpm::stress());
  registry.add(mpm::time_step(), mpm::time_stepping(problem));
  registry.add(render::background());
  registry.add(render::heightfield());
  registry.add(render::particles(), render::coloring(problem));
  registry.add(render::shadow_map());
  registry.add(render::surface(), render::meshing(problem));
  return registry;
}

}  // namespace firn::stages
