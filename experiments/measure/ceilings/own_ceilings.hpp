#pragma once
/// Our own measurement of ceilings, used if likwid-bench is missing.
#include "experiments/measure/ceilings/generated_code.hpp"

#include <cstddef>
#include <string>

namespace dss {

/// The mix for peak arithmetic: fused multiply-adds in registers; in scalar code, sums and
/// products.
constexpr int peak_instructions = 240;
InstructionMix peak_mix(bool is_scalar);

/// Flops/s of that mix on a number of threads. @throws InputError without binutils, or on a
/// processor other than x86
double own_peak_flops(const InstructionSet& isa, bool is_double, int threads);

/// Bytes/s of an f64 stream over `bytes` bytes per thread. `benchmark` begins with load, copy or
/// triad. Bytes are counted as likwid-bench does: the read before a store is not counted.
/// @throws InputError without binutils, or on a processor other than x86
double own_bandwidth(const InstructionSet& isa, const std::string& benchmark, std::size_t bytes,
                     int threads);

} // namespace dss
