#pragma once
/// What a microbenchmark times: a kernel of a variant on a working set, whole steps of a plate, or a device's kernel on it.
#include "experiments/microbenchmarks/working_set.hpp"
#include "variants/api.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace dss {

/// Something that is timed; made anew for each thread and sample.
class MicroWork {
public:
  virtual ~MicroWork() = default;
  virtual void pass() = 0; ///< once over the working set, or a step
};

struct MicroCase {
  std::string kernel; ///< as `list kernels` has it, or rk4_step, or rates
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  std::string variant, isa;
  std::string level;
  std::size_t working_set_bytes = 0; ///< of one thread
  int threads = 1;
  int n = 0;                       ///< of rk4_step and rates: elements a side
  double flops = 0, bytes = 0;     ///< an element and pass, declared
  double elements = 0;             ///< a pass, all threads
  bool is_threaded_inside = false; ///< the work itself has the threads
  std::string skipped;             ///< why it cannot be timed here, or empty
  std::function<std::unique_ptr<MicroWork>()> make;
  std::function<double()>
      error; ///< of its results, relative, against long double, or of steps and rates against the oracle; null: it is the oracle

  /// What makes two results comparable: "stage_row/spatial/f64/avx512/L2/1".
  std::string cell() const;
  double tolerance() const { return precision == Precision::f64 ? (n > 0 ? 1e-9 : 1e-12) : n > 0 ? 1e-4 : 2e-5; }
};

/// A kernel of a plug-in on a working set.
MicroCase kernel_case(const Plugin& plugin, const CompiledKernel& kernel, const std::string& level, int threads);

/// RK4 steps of the paper's plate with n x n elements. Bytes are those that a step must move: the state, read and written.
MicroCase step_case(const Plugin& plugin, Model model, Precision precision, int n, int threads);

/// The kernel of a device that computes the rates of all elements of the same plate, launched by itself.
MicroCase rates_case(const Plugin& plugin, Model model, Precision precision, int n, int threads);

/// What a set of a study asks for; "*" and -1 are all.
struct MicroSet {
  std::vector<std::string> kernels, models, precisions, variants, levels;
  std::vector<int> threads, sizes; ///< sizes: n of rk4_step and rates
};

/// Every case of a set, in a fixed order; variants that cannot run here make one case each that is skipped.
/// @throws InputError for a name that is not there, naming the nearest
std::vector<MicroCase> micro_cases(const MicroSet& set);

} // namespace dss
