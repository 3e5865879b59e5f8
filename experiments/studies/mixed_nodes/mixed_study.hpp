#pragma once
/// Simulated clusters of nodes of several speeds. README.md describes the JSON.
#include "experiments/base/progress.hpp"
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "solver/scene/scene.hpp"

#include <map>
#include <string>
#include <vector>

namespace dss {

/// Steps of each simulation.
inline constexpr int mixed_simulated_steps = 20;

/// Numbers of nodes by kind.
using NodeMix = std::map<std::string, int>;

/// Clusters to simulate: every combination of problem, mix, network and strategy, with equal parts
/// and with parts by speed.
struct MixedCase {
  std::string label;
  std::vector<std::vector<Override>> sets;
  std::vector<std::string> platforms, halos;
  std::vector<NodeMix> mixes;
};

struct MixedStudy {
  std::string name, scene;
  long steps = 0;                       ///< times are given for so many
  std::map<std::string, double> speeds; ///< of each kind of node [element-steps/s]
  std::vector<MixedCase> cases;
  std::vector<std::vector<Override>> held_sets; ///< problems of the comparison with runs
  long pairs = 0;
};

/// Reads the key "mixed_nodes". @throws InputError with the file, the JSON pointer and the mistake
MixedStudy read_mixed(const StudyFile& file);

/// Table of the simulated clusters.
Table mixed_table(const MixedStudy& study, Progress& progress);
/// Table of the simulator against runs that exchange nothing.
Table held_table(const MixedStudy& study, Progress& progress);

/// Both tables as text.
std::string mixed_text(const Table& mixed, const Table& held);

} // namespace dss
