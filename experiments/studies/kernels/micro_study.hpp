#pragma once
/// The study of microbenchmarks (experiments/README.md describes the JSON): kernels on their
/// working sets, ceilings, attribution.
#include "experiments/measure/kernels/micro_run.hpp"
#include "experiments/studies/kernels/attribution.hpp"
#include "experiments/studies/study.hpp"

#include <memory>
#include <string>

namespace dss {

struct MicroStudy {
  std::string name, title, scale, path;
  std::vector<MicroSet> sets;
  std::vector<AttributionCase> attribution;
  MicroRules rules;
  int attribution_rounds = 15;
  double attribution_sample_s = 5e-3;
  bool has_ceilings = true;
};

/// Reads the key "microbenchmarks". @throws InputError: file, JSON pointer, what is wrong
MicroStudy read_micro_study(const StudyFile& file);

/// The study: raw/NAME.csv as measured, tables/NAME.csv, tables/ceilings.csv,
/// tables/attribution.csv of raw/attribution.csv. A run that resumes keeps the records that are
/// there.
std::unique_ptr<Study> kernel_study(MicroStudy study);

} // namespace dss
