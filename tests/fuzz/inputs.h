#pragma once

// Any bytes at all as a file of Firn's, looked at as `firn check` looks at it, without a device. For the fuzzers and for the
// replay of what they found.

#include "tests/fuzz/sandbox.h"

namespace firn::fuzz {

// The input as a pipeline, a scene, a stage that is a file. Input errors are the answer that is hoped for; anything else that is
// thrown, and a plan with a memory hazard, is a finding and leaves the function.
void check_pipeline(const Sandbox& sandbox, std::string_view text);
void check_scene(const Sandbox& sandbox, std::string_view text);
void check_stage(const Sandbox& sandbox, std::string_view text);

}  // namespace firn::fuzz
