#include "scene/materials.h"

#include <cmath>
#include <set>

#include "tests/scene/support.h"

namespace firn::test {

using scene::MaterialPreset;

TEST_CASE("every preset keeps within its own range of densities and within the ranges that a scene may give") {
  for (const MaterialPreset& preset : scene::material_presets()) {
    const scene::Material& material = preset.material;
    INFO(material.name);
    CHECK(material.preset == material.name);
    CHECK(material.min_density > 0);
    CHECK(material.min_density <= material.density);
    CHECK(material.density <= material.max_density);
    CHECK(material.min_density < material.max_density);
    CHECK(material.young > 0);
    CHECK(material.poisson >= 0);
    CHECK(material.poisson < 0.5);
    CHECK(material.hardening >= 0);
    CHECK(material.critical_compression > 0);
    CHECK(material.critical_compression < 1);
    CHECK(material.critical_stretch > 0);
    CHECK(material.critical_stretch < 1);
    CHECK(material.slope > 0);
    CHECK(material.color.minCoeff() >= 0);
    CHECK(material.color.maxCoeff() <= 1);
    CHECK_FALSE(preset.doc.empty());
    CHECK_FALSE(preset.source.empty());
    CHECK(std::isfinite(scene::sound_speed(material)));
  }
}

TEST_CASE("a scene accepts the numbers of every preset when it writes them out") {
  for (const MaterialPreset& preset : scene::material_presets()) {
    const scene::Material& m = preset.material;
    INFO(m.name);
    std::ostringstream text;
    text.precision(17);
    text << "firn: 1\nmaterials:\n  m: {density: " << m.density << ", young: " << m.young << ", poisson: " << m.poisson
         << ", hardening: " << m.hardening << ", critical_compression: " << m.critical_compression
         << ", critical_stretch: " << m.critical_stretch << ", min_density: " << m.min_density << ", max_density: " << m.max_density
         << ", slope: " << m.slope << ", color: [" << m.color.x() << ", " << m.color.y() << ", " << m.color.z()
         << "]}\nfield: {size: [1, 1], cells: [8, 8], depth: 1, material: m}\n";
    const scene::Scene scene = good_scene(text.str());
    CHECK(scene.materials[0].young == m.young);
  }
}

TEST_CASE("the kinds of snow of both theses are there, with the densities of their tables") {
  const struct {
    const char* name;
    double min, max;
  } tables[] = {{"new_snow", 50, 150}, {"powder", 100, 200},   {"granular", 150, 450},
                {"settled", 350, 600}, {"firn", 500, 850},     {"glacier", 700, 900},
                {"dry_new", 30, 50},   {"bound_new", 50, 100}, {"strongly_bound_new", 100, 200},
                {"dry_old", 200, 400}, {"wet_old", 300, 500},  {"depth_hoar", 150, 300},
                {"ice", 800, 900}};
  for (const auto& row : tables) {
    INFO(row.name);
    const MaterialPreset* preset = scene::find_preset(row.name);
    REQUIRE(preset != nullptr);
    CHECK(preset->material.min_density == row.min);
    CHECK(preset->material.max_density == row.max);
  }
}

TEST_CASE("packed snow has the defaults of Stomakhin 2013, dry lies below its thresholds, wet above") {
  const scene::Material& packed = scene::find_preset("packed")->material;
  CHECK(packed.density == 400);
  CHECK(packed.young == 1.4e5);
  CHECK(packed.poisson == 0.2);
  CHECK(packed.hardening == 10);
  CHECK(packed.critical_compression == 2.5e-2);
  CHECK(packed.critical_stretch == 7.5e-3);
  const scene::Material& dry = scene::find_preset("dry")->material;
  const scene::Material& wet = scene::find_preset("wet")->material;
  CHECK(dry.critical_compression < packed.critical_compression);
  CHECK(dry.critical_stretch < packed.critical_stretch);
  CHECK(wet.critical_compression > packed.critical_compression);
  CHECK(wet.critical_stretch > packed.critical_stretch);
}

TEST_CASE("sand is hardly compressed and stands less steeply than snow") {
  const scene::Material& sand = scene::find_preset("sand")->material;
  CHECK(sand.max_density - sand.min_density <= 0.1 * sand.max_density);
  for (const MaterialPreset& preset : scene::material_presets())
    if (preset.material.name != "sand") CHECK(sand.slope < preset.material.slope);
}

TEST_CASE("preset names are unique, and an unknown one is nothing") {
  const std::vector<std::string> names = scene::preset_names();
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  CHECK(scene::find_preset("slush") == nullptr);
}

TEST_CASE("more than a thousand materials are refused, once") {
  std::string text = "firn: 1\nfield: {size: [1, 1], cells: [8, 8], depth: 1, material: powder}\nmaterials:\n";
  for (int i = 0; i < 1000; ++i) text += "  m" + std::to_string(i) + ": {}\n";
  CHECK(read_text(text).text().empty());
  CHECK(read_text(text + "  last: {}\n").text() == "scene.yaml:1004:3: error: more than 1000 materials\n");
}

TEST_CASE("Sigrist's lines at the values that the theses print") {
  CHECK(scene::sigrist_young(400) == Approx(84e6).epsilon(0.01));  // [M 15]: 84 MPa
  CHECK(scene::sigrist_poisson(400) == Approx(0.25).epsilon(1e-12));
  CHECK(scene::sigrist_poisson(1200) == 0.49);
  CHECK(scene::sigrist_poisson(-200) == 0);
}

TEST_CASE("the rule for the simulation's modulus passes through Stomakhin's default and stays below Sigrist's") {
  CHECK(scene::simulation_young(400) == Approx(1.4e5).epsilon(1e-12));
  CHECK(scene::simulation_young(200) == Approx(3.5e4).epsilon(1e-12));
  for (double density = 30; density <= 900; density += 10) CHECK(scene::simulation_young(density) < scene::sigrist_young(density));
}

TEST_CASE("Lame parameters and the speed of sound at values worked out by hand") {
  scene::Material material;
  material.young = 1e6;
  material.poisson = 0.25;
  material.density = 400;
  CHECK(scene::lame_mu(material) == Approx(4e5).epsilon(1e-12));
  CHECK(scene::lame_lambda(material) == Approx(4e5).epsilon(1e-12));
  CHECK(scene::sound_speed(material) == Approx(std::sqrt(3000.0)).epsilon(1e-12));
}

}  // namespace firn::test
