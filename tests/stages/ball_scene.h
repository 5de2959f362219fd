#pragma once

namespace firn::test {

// A small snowball on its way to the ground.
inline constexpr const char* ball_text = R"(
firn: 1
name: ball
time: {dt: 2.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [1, 1, 1], cell: 0.0625}
materials: {ball: {density: 400, young: 1.4e5}}
snow: [{sphere: {center: [0.5, 0.4, 0.5], radius: 0.2}, material: ball, velocity: [1, -2, 0.5]}]
bodies:
  - {plane: {point: [0, 0.2, 0], normal: [0, 1, 0]}, friction: 0.3}
)";

}  // namespace firn::test
