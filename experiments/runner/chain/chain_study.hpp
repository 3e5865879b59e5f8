#pragma once
/// The chain of factors (experiments/README.md describes the JSON): from the straightforward code to the cheapest run of the same accuracy, all links timed in
/// turn, each with the error that it leaves.
#include "experiments/runner/records.hpp"
#include "experiments/runner/study_sets.hpp"
#include "solver/model/model.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// One way to compute the scene; a link has what the one before has, and what it names.
struct ChainLink {
  std::string label, variant, integrator;
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  int threads = 1;
  long steps_an_interval = 0; ///< between saved times
};

struct ChainStudy {
  std::string name, title, scale, scene;
  std::vector<Override> set;
  double end_time = 0; ///< [s]
  int saved_times = 1;
  double bar = 0; ///< error that the end must keep
  ChainLink solution;
  std::vector<ChainLink> links;
  int repetitions = 9;
  double sample_s = 0.1;
};

/// Nothing if the study has no key "chain". @throws InputError: file, JSON pointer, what is wrong
std::optional<ChainStudy> load_chain(const std::string& study, const std::string& scale);

/// Measures it: raw/NAME.csv as measured, tables/NAME.csv. With `resumes` records present stay.
/// @return false if a link's states are wrong or the last is less accurate than the bar. @throws InputError if nothing can be recorded
bool run_chain(const ChainStudy& study, const std::string& directory, bool resumes);

} // namespace dss
