#include "scene/materials.h"

#include <algorithm>
#include <cmath>

namespace firn::scene {

namespace {

// Critical compression and stretch. [M 5.3] gives the direction only (larger: wet, chunky; smaller: dry powder); the numbers of
// `dry` and `wet` are our decision, about a third below and two thirds above the default.
struct Thresholds {
  double compression, stretch;
};
constexpr Thresholds usual{2.5e-2, 7.5e-3};    // Stomakhin 2013
constexpr Thresholds dry{1.9e-2, 5.0e-3};      // powdery
constexpr Thresholds wet{4.0e-2, 1.2e-2};      // chunky, with fracture edges
constexpr Thresholds brittle{2.5e-2, 2.0e-3};  // the two snowballs of [M 5.2]

// Hardening xi: 10 is the default of Stomakhin 2013, 30 that of the two snowballs; 20 for what lies between is our decision.
constexpr double usual_hardening = 10, firm_hardening = 20, icy_hardening = 30;

// Steepest slope: 0.6 in the pictures of the height-field thesis; steeper for moist, well bound snow, flatter for loose
// round or cup-shaped grains are our decision.
constexpr double usual_slope = 0.6, bound_slope = 0.8, loose_slope = 0.5, sand_slope = 0.45;

constexpr double ice_poisson = 0.33;  // solid ice; Sigrist's line, fitted to snow, passes it at 560 kg/m3

struct Row {
  const char* name;
  double density, min_density, max_density;  // kg/m3
  double hardening;
  Thresholds thresholds;
  double slope;
  const char* doc;
  const char* source;
};

constexpr const char* table_m = "densities: [M tab. 1]";
constexpr const char* table_h = "densities: [H tab. 3.1]";

const Row rows[] = {
    {"new_snow", 100, 50, 150, usual_hardening, dry, usual_slope, "freshly fallen snow, light and powdery", table_m},
    {"powder", 150, 100, 200, usual_hardening, dry, loose_slope, "dry powder that sprays and does not clump", table_m},
    {"granular", 300, 150, 450, usual_hardening, brittle, loose_slope, "coarse round grains, barely bound", table_m},
    {"settled", 450, 350, 600, usual_hardening, usual, usual_slope, "old snow that has settled under its own weight", table_m},
    {"firn", 650, 500, 850, firm_hardening, brittle, bound_slope, "snow of a past winter, hard and brittle",
     "densities: [M tab. 1]; [H tab. 3.1] ends at 800"},
    {"glacier", 800, 700, 900, icy_hardening, brittle, bound_slope, "glacier ice with air in it", table_m},
    {"dry_new", 40, 30, 50, usual_hardening, dry, loose_slope, "dry, loose new snow, the lightest there is", table_h},
    {"bound_new", 75, 50, 100, usual_hardening, dry, usual_slope, "slightly bound new snow", table_h},
    {"strongly_bound_new", 150, 100, 200, usual_hardening, usual, bound_slope, "strongly bound new snow that holds a form",
     table_h},
    {"dry_old", 300, 200, 400, usual_hardening, dry, usual_slope, "old snow of a cold winter", table_h},
    {"wet_old", 400, 300, 500, usual_hardening, wet, bound_slope, "old snow that melts: chunky, packs well", table_h},
    {"depth_hoar", 220, 150, 300, usual_hardening, brittle, loose_slope, "cup-shaped crystals without hold, like sugar", table_h},
    {"ice", 850, 800, 900, icy_hardening, brittle, bound_slope, "ice, hard and brittle", table_h},
};

// Variants of the snow of Stomakhin 2013 at 400 kg/m3, with E and nu of that paper instead of the rules by density.
const Row packed_rows[] = {
    {"packed", 400, 200, 600, usual_hardening, usual, usual_slope, "packed snow, as in a snowball",
     "Stomakhin 2013, defaults; density range: dry old snow [H tab. 3.1] to settled snow [M tab. 1]"},
    {"dry", 400, 200, 600, usual_hardening, dry, usual_slope, "packed snow that is dry: breaks to powder",
     "packed, with smaller critical compression and stretch [M 5.3]"},
    {"wet", 400, 200, 600, usual_hardening, wet, bound_slope, "packed snow that is wet: breaks to chunks with sharp edges",
     "packed, with larger critical compression and stretch [M 5.3]"},
};

MaterialPreset preset_of(const Row& row, double young, double poisson, const char* rules) {
  MaterialPreset preset;
  Material& material = preset.material;
  material.name = material.preset = row.name;
  material.density = row.density;
  material.young = young;
  material.poisson = poisson;
  material.hardening = row.hardening;
  material.critical_compression = row.thresholds.compression;
  material.critical_stretch = row.thresholds.stretch;
  material.min_density = row.min_density;
  material.max_density = row.max_density;
  material.slope = row.slope;
  preset.doc = row.doc;
  preset.source = std::string(row.source) + rules;
  return preset;
}

// Height-field snow that hardly compresses: nearly all of it is pushed away [H 3.9]. Dry quartz sand weighs about 1500 kg/m3.
MaterialPreset sand() {
  const Row row{
      "sand",
      1500,
      1450,
      1550,
      usual_hardening,
      brittle,
      sand_slope,
      "dry sand, for the height field: pushed away rather than compressed",
      "[H 3.29-3.33]: rho_min close to rho_max, smaller phi; the numbers are our decision; its elastic numbers are those of "
      "granular snow, which as particles stays snow"};
  MaterialPreset preset = preset_of(row, simulation_young(300), sigrist_poisson(300), "");
  preset.material.color = {0.80, 0.68, 0.47};
  return preset;
}

std::vector<MaterialPreset> make_presets() {
  std::vector<MaterialPreset> presets;
  for (const Row& row : packed_rows) presets.push_back(preset_of(row, 1.4e5, 0.2, ""));
  for (const Row& row : rows) {
    const double poisson = std::min(sigrist_poisson(row.density), ice_poisson);
    presets.push_back(
        preset_of(row, simulation_young(row.density), poisson,
                  "; E = 1.4e5 Pa (density / 400)^2, our rule; nu: Sigrist 2006 [M 16], at most that of ice; thresholds, "
                  "hardening and slope: our decision after [M 5.3] and [H 3.29-3.33]"));
  }
  presets.push_back(sand());
  return presets;
}

}  // namespace

const std::vector<MaterialPreset>& material_presets() {
  static const std::vector<MaterialPreset> presets = make_presets();
  return presets;
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const MaterialPreset& preset : material_presets()) names.push_back(preset.material.name);
  return names;
}

const MaterialPreset* find_preset(const std::string& name) {
  for (const MaterialPreset& preset : material_presets())
    if (preset.material.name == name) return &preset;
  return nullptr;
}

double sigrist_young(double density) { return 1.89 * std::pow(density, 2.94); }  // 1.89e-6 MPa = 1.89 Pa

double sigrist_poisson(double density) { return std::clamp(0.2 + (density - 300) * 5e-4, 0.0, 0.49); }

double simulation_young(double density) {
  const double ratio = density / 400;
  return 1.4e5 * ratio * ratio;
}

double lame_mu(const Material& material) { return material.young / (2 * (1 + material.poisson)); }

double lame_lambda(const Material& material) {
  return material.young * material.poisson / ((1 + material.poisson) * (1 - 2 * material.poisson));
}

double sound_speed(const Material& material) {
  return std::sqrt((lame_lambda(material) + 2 * lame_mu(material)) / material.density);
}

}  // namespace firn::scene
