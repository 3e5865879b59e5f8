#pragma once
/// The chain of factors: stages that lead from straightforward code to the cheapest run of the same
/// accuracy. All stages are timed in turn, and each has its error. README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "kernels/model.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A stage of the chain: one way to compute the scene. It keeps all values of the stage before,
/// except those that it names.
struct ChainStage {
  std::string label, variant, integrator;
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  int threads = 1;
  long steps_an_interval = 0; ///< steps between saved times
};

/// The scene, the stages and the rules of timing.
struct ChainStudy {
  std::string name, title, scale, scene;
  std::vector<Override> set;
  double end_time = 0; ///< [s]
  int saved_times = 1;
  double bar = 0; ///< largest error that the last stage may have
  ChainStage solution;
  std::vector<ChainStage> stages;
  int repetitions = 9;
  double sample_s = 0.1;
};

/// Reads the key "chain". @throws InputError with the file, the JSON pointer and the mistake
ChainStudy read_chain(const StudyFile& file);

} // namespace dss
