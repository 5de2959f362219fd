#include "stages/bodies/integrate.h"

#include "stages/mpm_ports.h"

namespace firn::stages::bodies {

graph::StageSpec integrate() {
  using enum graph::Access;
  std::vector<graph::Port> ports;
  for (const char* name : {"body_position", "body_orientation", "body_velocity", "body_spin"})
    ports.push_back(mpm::body(name, read_write));
  for (const char* name : {"body_mass", "body_path"}) ports.push_back(mpm::body(name, read));
  for (const graph::Port& port : mpm::key_frames(read)) ports.push_back(port);
  return {.name = "bodies.integrate",
          .doc = "Moves rigid bodies over one step: along their paths, by gravity where they have a mass, else as told",
          .equation = "[M 3.4 step 10]",
          .ports = ports,
          .constants = {"gravity"},
          .work = {graph::Dispatch{.kernel = "bodies/integrate.comp", .over = "bodies"}}};
}

}  // namespace firn::stages::bodies
