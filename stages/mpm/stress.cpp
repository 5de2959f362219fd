#include "stages/mpm/stress.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec stress() {
  return {
      .name = "mpm.stress",
      .doc = "Stress of particles from their deformation, times their volume",
      .equation = "[M 26, 29-32]",
      .ports = {elastic(Access::read), plastic_det(Access::read), volume(Access::read), material(Access::read),
                material_elastic(Access::read), stress(Access::write), stress_max(Access::accumulate)},
      .parameters = {accumulate_parameter()},
      .faults = {graph::Fault::not_a_number},
      .work = {graph::Dispatch{
          .kernel = "mpm/stress.comp", .over = "particles", .arithmetic = {{"particles", arithmetic::svd + arithmetic::stress}}}}};
}

}  // namespace firn::stages::mpm
