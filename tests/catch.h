#pragma once

// Catch2 2 is one header, Catch2 3 many.

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace firn::test {

// The seed of random tests: FIRN_SEED, or a fresh one. Tests say it with INFO("seed " << seed), so that a failure can be repeated.
inline std::uint64_t seed() {
  if (const char* text = std::getenv("FIRN_SEED")) return std::strtoull(text, nullptr, 10);
  static const std::uint64_t fresh = std::random_device{}();
  return fresh;
}

}  // namespace firn::test
