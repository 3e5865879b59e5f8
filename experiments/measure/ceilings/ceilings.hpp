#pragma once
/// Ceilings: the best rates of the processor. They are peak arithmetic and the bandwidth of each
/// memory level, measured by likwid-bench, or by our own code if likwid-bench is missing.
#include "experiments/base/records.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// One measured ceiling.
struct Ceiling {
  bool is_flops = false; ///< false: bytes
  std::string benchmark; ///< peakflops_avx512_fma, load, copy, triad
  std::string isa;       ///< scalar, avx2, avx512
  std::string precision; ///< f64, f32; empty for bytes
  std::string level;     ///< empty for flops
  std::size_t working_set_bytes = 0;
  int threads = 1;
  double per_s = 0; ///< flops/s or bytes/s; NaN: not measured
  std::string tool, command, reason;
};

/// Measures all ceilings of this CPU for each number of threads: peak arithmetic of each
/// instruction set and precision; load, copy and triad of each level with the widest instruction
/// set.
/// @param note  receives a line of text for each measured ceiling
std::vector<Ceiling> measure_ceilings(const std::vector<int>& threads,
                                      const std::function<void(const std::string&)>& note);

/// Convert ceilings to tables/ceilings.csv, and back.
Table ceiling_table(const std::vector<Ceiling>& ceilings);
std::vector<Ceiling> read_ceilings(const Table& table);

/// Best flops/s of an instruction set, and best bytes/s of a level of the processor; NaN if not
/// measured.
double peak_flops(const std::vector<Ceiling>& ceilings, const std::string& isa,
                  const std::string& precision, int threads);
double bandwidth(const std::vector<Ceiling>& ceilings, const std::string& level, int threads);

/// Empty if likwid-perfctr can read hardware counters here, else the reason.
std::string why_no_counters();

} // namespace dss
