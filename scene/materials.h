#pragma once

// Presets for kinds of snow, each number with its source (table in materials.cpp, docs/materials.md).

#include <string>
#include <vector>

#include "scene/scene.h"

namespace firn::scene {

struct MaterialPreset {
  Material material;   // name and preset = the preset's name
  std::string doc;     // one line: what it looks like
  std::string source;  // where its numbers are from
};
const std::vector<MaterialPreset>& material_presets();
std::vector<std::string> preset_names();
const MaterialPreset* find_preset(const std::string& name);  // nullptr: no such preset

// Sigrist 2006, from density in kg/m3 [M 15, 16]: Young's modulus in Pa and Poisson's ratio (held in 0..0.49).
double sigrist_young(double density);
double sigrist_poisson(double density);

// The Young's modulus that the presets use, Pa, from density in kg/m3: 1.4e5 (density / 400)^2. Our decision: it passes through
// the default of Stomakhin 2013 (1.4e5 Pa at 400 kg/m3), some 600 times softer there than Sigrist's measured value, so that
// explicit steps of 1e-4 s and more hold on cells of a few centimetres. The power 2 instead of Sigrist's 2.94 keeps light snow firm
// enough to bear a layer of its own: at 100 kg/m3, the foot of 0.15 m of it is compressed by 1.7 %, below the critical compression.
double simulation_young(double density);

// Lame parameters of [M 29-32] before hardening, Pa.
double lame_mu(const Material& material);
double lame_lambda(const Material& material);

// Speed of pressure waves in the undeformed material, m/s: sqrt((lambda + 2 mu) / rho).
double sound_speed(const Material& material);

}  // namespace firn::scene
