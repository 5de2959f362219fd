// What libFuzzer calls. FIRN_FUZZ_TARGET: the function of inputs.h or files.h that is fuzzed.

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/files.h"
#include "tests/fuzz/inputs.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const firn::fuzz::Sandbox sandbox;
  firn::fuzz::FIRN_FUZZ_TARGET(sandbox, {reinterpret_cast<const char*>(data), size});
  return 0;
}
