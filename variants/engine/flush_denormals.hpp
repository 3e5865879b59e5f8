#pragma once
/// Denormal numbers count as zero while this lives, on the calling thread (design.md section 5): MXCSR bits FTZ and
/// DAZ.
#include <xmmintrin.h>

namespace dss {

class FlushDenormals {
public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
  unsigned saved_;
};

} // namespace dss
