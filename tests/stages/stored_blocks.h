#pragma once

// Snow on a grid of which only blocks are stored: made, run through stages, and laid out as the whole grid again.

#include "tests/stages/random_snow.h"

namespace firn::test {

constexpr double block_dt = 0x1p-13;  // s, of every run here

// Snow in a few lumps far from each other, on a grid whose sides are no multiples of four.
RandomSnow lumps(std::uint64_t seed, int count);

// `stages`: the lines of the step.
Arrays run(const RandomSnow& snow, const std::string& stages, Arrays in, int steps = 1);

std::vector<Matrix3d> symmetric_stress(const RandomSnow& snow);

// A buffer of stored nodes, laid out as the whole grid; zero where nothing is stored.
std::vector<float> whole(const Arrays& out, const std::string& buffer, const Eigen::Vector3i& nodes);

}  // namespace firn::test
