#pragma once
/// What a microbenchmark times: a kernel of a variant on a working set, steps of a plate, or the
/// rates kernel of a device.
#include "experiments/measure/kernels/micro_work.hpp"
#include "experiments/measure/kernels/working_set.hpp"
#include "variants/api/api.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace dss {

/// One microbenchmark: one kernel of one variant, with its size and its declared cost.
struct MicroCase {
  std::string kernel; ///< a name of `list kernels`, or rk4_step, or rates
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  std::string variant, isa;
  std::string level;
  std::size_t working_set_bytes = 0; ///< bytes of one thread
  int threads = 1;
  int n = 0;                       ///< of rk4_step and rates: elements along an edge of the plate
  double flops = 0, bytes = 0;     ///< declared cost per element and pass
  double elements = 0;             ///< elements per pass, of all threads
  bool is_threaded_inside = false; ///< the work starts its own threads
  std::string skipped;             ///< reason why it cannot be timed here, or empty
  std::function<std::unique_ptr<MicroWork>()> make;
  /// Relative error of the results: kernels against long double, steps and rates against the
  /// oracle. Null if the variant is the oracle.
  std::function<double()> error;

  /// Name of the configuration; results with the same name are comparable:
  /// "stage_row/spatial/f64/avx512/L2/1".
  std::string cell() const;
  double tolerance() const {
    return precision == Precision::f64 ? (n > 0 ? 1e-9 : 1e-12) : n > 0 ? 1e-4 : 2e-5;
  }
};

/// A kernel of a plug-in on a working set.
MicroCase kernel_case(const Plugin& plugin, const CompiledKernel& kernel, const std::string& level,
                      int threads);

/// RK4 steps of the paper's plate with n x n elements. Declared bytes are the least that a step
/// must move: the state, read once and written once.
MicroCase step_case(const Plugin& plugin, Model model, Precision precision, int n, int threads);

/// The device kernel that computes the rates of all elements of the same plate, without the rest of
/// a step.
MicroCase rates_case(const Plugin& plugin, Model model, Precision precision, int n, int threads);

/// Selection of microbenchmarks by a study. "*" selects all names.
struct MicroSet {
  std::vector<std::string> kernels, models, precisions, variants, levels;
  std::vector<int> threads, sizes; ///< sizes: n of rk4_step and rates
};

/// Every case of a set, in a fixed order. A variant that cannot run here gives one skipped case.
/// @throws InputError with the nearest known name for an unknown name
std::vector<MicroCase> micro_cases(const MicroSet& set);

} // namespace dss
