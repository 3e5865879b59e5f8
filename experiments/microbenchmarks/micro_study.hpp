#pragma once
/// The study of microbenchmarks (experiments/README.md describes the JSON): kernels on their working sets, ceilings, attribution.
#include "experiments/microbenchmarks/attribution.hpp"
#include "experiments/microbenchmarks/micro_run.hpp"

#include <optional>
#include <string>

namespace dss {

struct MicroStudy {
  std::string name, title, scale;
  std::vector<MicroSet> sets;
  std::vector<AttributionCase> attribution;
  MicroRules rules;
  int attribution_rounds = 15;
  double attribution_sample_s = 5e-3;
  bool has_ceilings = true;
};

/// Nothing if the study has no key "microbenchmarks". @throws InputError: file, JSON pointer, what is wrong
std::optional<MicroStudy> load_micro_study(const std::string& study, const std::string& scale);

/// Measures it: raw/NAME.csv as measured, tables/NAME.csv, tables/ceilings.csv, tables/attribution.csv of raw/attribution.csv. With `resumes` records present stay.
/// @return false if a kernel's results were wrong. @throws InputError if nothing can be recorded
bool run_micro_study(const MicroStudy& study, const std::string& directory, bool resumes);

} // namespace dss
