#include "stages/bodies/integrate.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::bodies {

graph::StageSpec integrate() {
  using enum graph::Access;
  std::vector<graph::Port> ports;
  for (const char* name : {"body_position", "body_orientation", "body_velocity", "body_spin"})
    ports.push_back(mpm::body(name, read_write));
  for (const char* name : {"body_mass", "body_path"}) ports.push_back(mpm::body(name, read));
  for (const graph::Port& port : mpm::key_frames(read)) ports.push_back(port);
  ports.push_back(heightfield::optional_body("body_inertia", read));
  for (const char* name : {"resistance", "contact_point", "support", "support_point"})
    ports.push_back(heightfield::optional(name, read));
  for (const char* name : {"body_position_before", "body_orientation_before"})
    ports.push_back(heightfield::optional_body(name, write));
  return {
      .name = "bodies.integrate",
      .doc =
          "Moves rigid bodies over one step: along their paths; else, where they have a mass, by gravity and what the snow does "
          "to them; else as told",
      .equation = "[M 3.4 step 10, H 3.8]",
      .ports = ports,
      .constants = {"gravity"},
      .work = {graph::Dispatch{.kernel = "bodies/integrate.comp", .over = "bodies"}}};
}

}  // namespace firn::stages::bodies
