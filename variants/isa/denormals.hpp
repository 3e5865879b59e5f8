#pragma once
/// Denormal numbers count as zero (DESIGN.md section 5). Linux hands the mode down to threads that
/// are started later.
#include "variants/isa/architecture.hpp"

#include <cstdlib>

namespace dss {

/// DSSBENCH_KEEP_DENORMALS=1: denormals stay numbers, on devices too. Slower, and for comparing
/// bits with devices that cannot flush: GPUs in double precision.
inline bool are_denormals_kept() {
  const char* const asked = std::getenv("DSSBENCH_KEEP_DENORMALS");
  return asked != nullptr && *asked == '1';
}
inline void flush_denormals() {
  if (!are_denormals_kept()) isa::set_float_mode(isa::float_mode() | isa::flush_bits);
}
inline bool are_denormals_flushed() {
  return (isa::float_mode() & isa::flush_bits) == isa::flush_bits;
}

/// Flushes denormals on the calling thread while it lives.
class FlushDenormals {
public:
  FlushDenormals() : saved_(isa::float_mode()) { flush_denormals(); }
  ~FlushDenormals() { isa::set_float_mode(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
  isa::FloatMode saved_;
};

} // namespace dss
