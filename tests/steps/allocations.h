#pragma once

// Memory that C++ code of this program takes from the heap. Drivers in C are not seen.

#include <cstdint>

namespace firn::test {

// Of the calling thread, since it began.
std::uint64_t allocations();

}  // namespace firn::test
