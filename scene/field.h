#pragma once

// The field of a scene as numbers per cell.

#include <vector>

#include "scene/scene.h"

namespace firn::scene {

// Cells [z, x], x fastest, row 0 at the smallest z.
struct FieldArrays {
  std::vector<float> ground;   // m
  std::vector<float> depth;    // m of snow, never negative
  std::vector<float> density;  // kg/m3, within the material's limits; where no snow lies too
};

// Images are resampled to the field's cells (scene/image.h). The scene must have a field. Throws config::InputError, with every
// error and its place in the scene file: an image that cannot be read, a negative depth, snow outside its material's densities.
FieldArrays sample_field(const Scene& scene);

}  // namespace firn::scene
