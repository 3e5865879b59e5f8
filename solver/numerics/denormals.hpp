#pragma once
/// Denormal numbers count as zero (DESIGN.md section 5), where the CPU can: MXCSR bit 15 flushes
/// results to zero (FTZ), bit 6 takes operands as zero (DAZ). Linux hands MXCSR down to threads
/// that are started later.
#include <cstdlib>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace dss {

#if defined(__SSE2__)
inline constexpr unsigned flush_bits = 0x8040;
inline unsigned float_mode() { return _mm_getcsr(); }
inline void set_float_mode(unsigned mode) { _mm_setcsr(mode); }
#else
inline constexpr unsigned flush_bits = 0;
inline unsigned float_mode() { return ~0u; }
inline void set_float_mode(unsigned) {}
#endif

/// DSSBENCH_KEEP_DENORMALS=1: denormals stay numbers, on devices too. Slower, and for comparing
/// bits with devices that cannot flush: GPUs in double precision.
inline bool are_denormals_kept() {
  const char* const asked = std::getenv("DSSBENCH_KEEP_DENORMALS");
  return asked != nullptr && *asked == '1';
}
inline void flush_denormals() {
  if (!are_denormals_kept()) set_float_mode(float_mode() | flush_bits);
}
inline bool are_denormals_flushed() {
  return flush_bits != 0 && (float_mode() & flush_bits) == flush_bits;
}

/// Flushes denormals on the calling thread while it lives.
class FlushDenormals {
public:
  FlushDenormals() : saved_(float_mode()) { flush_denormals(); }
  ~FlushDenormals() { set_float_mode(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
  unsigned saved_;
};

} // namespace dss
