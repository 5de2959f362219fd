#include "stages/mpm/deform_stress.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec deform_stress() {
  return {.name = "mpm.deform_stress",
          .doc = "What deform and stress do, in one: both need the singular values of the same matrix",
          .equation = "[M 21, 22, 26, 29-32]",
          .ports = {velocity_gradient(Access::read, Usage::sampled), material(Access::read, Usage::sampled),
                    material_plastic(Access::read, Usage::sampled), material_elastic(Access::read, Usage::sampled),
                    volume(Access::read, Usage::sampled), elastic(Access::read_write), plastic_det(Access::read_write),
                    stress(Access::write)},
          .faults = {graph::Fault::not_a_number},
          .work = {graph::Dispatch{
              .kernel = "mpm/deform_stress.comp",
              .over = "particles",
              .arithmetic = {{"particles", arithmetic::trial + arithmetic::svd + arithmetic::clamped + arithmetic::stress}}}}};
}

}  // namespace firn::stages::mpm
