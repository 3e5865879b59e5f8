#pragma once
/// What the processor gives at best: peak arithmetic and bandwidth of each level, by likwid-bench, or by code of our own where it is missing.
#include "experiments/runner/records.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// One measured bound.
struct Ceiling {
  bool is_flops = false; ///< else bytes
  std::string benchmark; ///< peakflops_avx512_fma, load, copy, triad
  std::string isa;       ///< scalar, avx2, avx512
  std::string precision; ///< f64, f32; empty for bytes
  std::string level;     ///< empty for flops
  std::size_t working_set_bytes = 0;
  int threads = 1;
  double per_s = 0; ///< NaN: not measured
  std::string tool, command, reason;
};

/// Measures all bounds of what this CPU has: each instruction set and precision; load, copy and triad of each level with the widest; on each of `threads`.
/// @param note  is told of each measured one
std::vector<Ceiling> measure_ceilings(const std::vector<int>& threads,
                                      const std::function<void(const std::string&)>& note);

/// tables/ceilings.csv, and back. @throws InputError if the table has other columns
Table ceiling_table(const std::vector<Ceiling>& ceilings);
std::vector<Ceiling> read_ceilings(const Table& table);

/// Best flops/s of an instruction set, and best bytes/s of a level of the processor; NaN where not measured.
double peak_flops(const std::vector<Ceiling>& ceilings, const std::string& isa, const std::string& precision,
                  int threads);
double bandwidth(const std::vector<Ceiling>& ceilings, const std::string& level, int threads);

/// Whether hardware counters can be read here by likwid-perfctr: empty, or why not.
std::string why_no_counters();

} // namespace dss
