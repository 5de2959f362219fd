#pragma once

// Inside gpu/ only: numbers below 1.2e-38 (denormals) as zero, as on GPUs.

#if defined(__SSE2__)
#include <pmmintrin.h>
#endif

namespace firn::gpu {

// While it lives, this thread takes denormals as zero, and so does, for good, every thread that it starts: a new thread takes over
// the floating-point mode. Processors take some 150 cycles for an operation on a denormal, and snow at rest has many of them.
class DenormalsAsZero {
 public:
#if defined(__SSE2__)
  DenormalsAsZero() {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~DenormalsAsZero() { _mm_setcsr(before_); }

 private:
  unsigned before_ = _mm_getcsr();

 public:
#else
  DenormalsAsZero() = default;
  ~DenormalsAsZero() = default;
#endif
  DenormalsAsZero(const DenormalsAsZero&) = delete;
  DenormalsAsZero& operator=(const DenormalsAsZero&) = delete;
};

}  // namespace firn::gpu
