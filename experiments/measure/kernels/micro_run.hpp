#pragma once
/// Times microbenchmarks with Google Benchmark. A round runs each case once, in random order, and
/// records it at once.
#include "experiments/base/records.hpp"
#include "experiments/measure/kernels/micro_case.hpp"

#include <functional>

namespace dss {

/// Number and length of the repetitions.
struct MicroRules {
  int repetitions = 9;    ///< of each case; 9 because `compare` needs 9 samples for its rank test
  double sample_s = 0.02; ///< shortest time of a repetition [s]
};

/// Columns of the raw file of microbenchmarks.
const std::vector<std::string>& micro_columns();

/// Runs all repetitions that are not recorded yet. Each case is checked before it is timed. A wrong
/// case is recorded with its error, and tables show no rate for it.
/// @param done  called before each repetition with the number of finished ones, the total and the
/// cell
void run_micro_cases(const std::string& experiment, const std::vector<MicroCase>& cases,
                     const MicroRules& rules, RecordFile& records,
                     const std::function<void(double, double, const std::string&)>& done);

} // namespace dss
