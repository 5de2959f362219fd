#pragma once

// Snow and what its exports are compared with.

#include <algorithm>
#include <bit>

#include "tests/catch.h"
#include "tests/stages/export_readers.h"
#include "tests/stages/render_shot.h"

namespace firn::test {

inline const std::string small_image = "64x36";
inline const std::string snow_setup = "[mpm.seed, bodies.place, {mpm.stress: {accumulate: float}}]";

// Snow under strain, so that no array is of one value.
struct Strained : Shot {
  Strained(const std::string& stages, const std::filesystem::path& output, const SceneText& scene = {})
      : Shot(scene.text(), snow_setup, stages, small_image, output.string()) {
    std::vector<float> velocity = read("velocity"), plastic = read("plastic_det"), stress = read("stress");
    for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] = 0.25f * static_cast<float>(i % 7) - 0.5f;
    for (std::size_t i = 0; i < plastic.size(); ++i) plastic[i] = 1 + 0.001f * static_cast<float>(i % 100);
    for (std::size_t i = 0; i < stress.size(); ++i) stress[i] = 0.01f * static_cast<float>(i % 11);
    std::vector<float> material(plastic.size());
    for (std::size_t i = 0; i < material.size(); ++i) material[i] = std::bit_cast<float>(static_cast<std::int32_t>(i % 3));
    write("material", material);
    write("velocity", velocity);
    write("plastic_det", plastic);
    write("stress", stress);
  }
};

inline std::vector<double> doubles(const std::vector<float>& values) { return {values.begin(), values.end()}; }

// Numbers of materials, as Strained has them.
inline std::vector<double> materials(std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(i % 3));
  return values;
}

inline void write_frames(Shot& shot, int count) {
  for (int i = 0; i < count; ++i) {
    shot.execution().clock().time = 0.125 * i;
    shot.frame();
  }
  shot.execution().finish();
}

inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace firn::test
