#pragma once

// Files of points: .npy of N x 3 (position, m) or N x 6 (position, then velocity in m/s), float32 or float64.
// Errors are std::runtime_error with a sentence that names the file.

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace firn::scene {

struct Points {
  std::vector<Vector3d> position;
  std::vector<Vector3d> velocity;  // empty where the file has none
};

// Refuses numbers that are not finite.
Points read_points(const std::string& file);

// N, from the file's header alone.
std::uint64_t count_points(const std::string& file);

}  // namespace firn::scene
