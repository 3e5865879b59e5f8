#pragma once
/// Times microbenchmarks with Google Benchmark: in rounds, each of all cases in random order, recorded as measured.
#include "experiments/microbenchmarks/micro_case.hpp"
#include "experiments/runner/records.hpp"

#include <functional>

namespace dss {

struct MicroRules {
  int repetitions = 9;    ///< of each case: the rank test of `compare` wants nine
  double sample_s = 0.02; ///< least time of a repetition
};

const std::vector<std::string>& micro_columns();

/// Runs what is not among the records yet. Each case is checked before it is timed: a wrong one is recorded with its error and gets no rate in tables.
/// @param done   is told of each case of a round: how many, of how many, which
void run_micro_cases(const std::string& experiment, const std::vector<MicroCase>& cases, const MicroRules& rules,
                     RecordFile& records, const std::function<void(double, double, const std::string&)>& done);

} // namespace dss
