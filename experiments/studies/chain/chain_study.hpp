#pragma once
/// The chain of factors: stages that lead from straightforward code to the cheapest run of the same
/// accuracy. All stages are timed in turn, and each has its error. README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "kernels/model.hpp"
#include "solver/numerics/method.hpp"

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
  long steps_an_interval = 0; ///< steps between saved times; of a neighbour 0: as long as stable
  std::optional<double> smoothing{}; ///< of a leapfrog, instead of that of its method
};

/// A stage with another value of a parameter that was chosen: shows what the choice is worth.
struct ChainNeighbour {
  std::size_t of = 0; ///< its stage
  ChainStage stage;
};

/// The scene, the stages and the rules of timing.
struct ChainStudy {
  std::string name, title, scale, path, scene;
  std::vector<Override> set;
  double end_time = 0; ///< [s]
  int saved_times = 1;
  double bar = 0; ///< largest error that the last stage may have
  ChainStage solution;
  std::vector<ChainStage> stages;
  std::vector<ChainNeighbour> neighbours;
  /// Stages and then neighbours: everything that is timed.
  std::vector<ChainStage> timed() const;
  int repetitions = 9;
  int samples = 1; ///< of a repetition; the fastest counts
  double sample_s = 0.1;
  /// Time for the errors of a slow stage [s]: they are taken at as many saved times as it reaches,
  /// but at least at one.
  double error_s = 30;
};

/// The method of a stage, with the smoothing of the stage.
Method method_of(const ChainStage& stage);

/// Reads the key "chain". @throws InputError with the file, the JSON pointer and the mistake
ChainStudy read_chain(const StudyFile& file);

} // namespace dss
