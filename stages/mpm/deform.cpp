#include "stages/mpm/deform.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec deform() {
  return {
      .name = "mpm.deform",
      .doc =
          "Deforms particles by the velocity gradient; beyond the critical compression and stretch the deformation becomes plastic",
      .equation = "[M 21, 22]",
      .ports = {velocity_gradient(Access::read), material(Access::read), material_plastic(Access::read),
                elastic(Access::read_write), plastic_det(Access::read_write)},
      .faults = {graph::Fault::not_a_number},
      .work = {graph::Dispatch{.kernel = "mpm/deform.comp",
                               .over = "particles",
                               .arithmetic = {{"particles", arithmetic::trial + arithmetic::svd + arithmetic::clamped}}}}};
}

}  // namespace firn::stages::mpm
