#pragma once
/// Ceilings by code of our own, where likwid-bench is missing.
#include "experiments/microbenchmarks/generated_code.hpp"

#include <cstddef>
#include <string>

namespace dss {

/// The mix of peak arithmetic: fused multiply-adds in registers, or sums and products where there are none.
constexpr int peak_instructions = 240;
InstructionMix peak_mix(bool is_scalar);

/// Flops/s of that mix, on so many threads. @throws InputError without binutils
double own_peak_flops(const std::string& isa, const std::string& precision, int threads);

/// Bytes/s of a stream in f64 over so many bytes a thread; `benchmark` begins with load, copy or triad. Bytes are counted as likwid-bench does,
/// without what a store must read first. @throws InputError without binutils
double own_bandwidth(const std::string& isa, const std::string& benchmark, std::size_t bytes, int threads);

} // namespace dss
