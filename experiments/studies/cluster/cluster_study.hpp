#pragma once
/// The simulated part of a study. Its table has separate columns for published, measured and
/// simulated times. experiments/README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "solver/scene/scene.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Published time of one node [s], with its problem size.
struct PublishedNode {
  double wall_s = 0, elements = 0, steps = 0;
};

/// A block of simulations. Every combination is simulated twice: with the published node, and with
/// a node of cores like one of this machine.
struct SimulationBlock {
  std::string label, scene;
  std::vector<std::vector<Override>> sets;           ///< or, for weak scaling, set_of_ranks
  std::map<int, std::vector<Override>> set_of_ranks; ///< overrides for each number of ranks
  std::vector<int> ranks;
  std::vector<std::string> platforms, halos, decompositions;
  long steps = 0;                         ///< steps of the problem; times are given for this many
  std::optional<PublishedNode> published; ///< absent: only our node
  std::map<int, double> paper_wall_s;     ///< published times [s], by ranks
  int node_cores = 1; ///< cores of our node: so many times as fast as one core of this machine
};

/// Reads the key "simulation", one block or a list. A scale may limit `most_ranks` and
/// `most_elements`, and leave out blocks by label. Everything is checked before the first
/// simulation.
/// @throws InputError with the file, the JSON pointer and the mistake
std::vector<SimulationBlock> read_simulation(const StudyFile& file);

/// Simulates all blocks.
/// @param measured  table of the study's measured cells; its times are shown beside the simulated
/// ones. May be empty.
Table simulate_study(const std::string& study, const std::vector<SimulationBlock>& blocks,
                     const Table& measured);

/// The table as text.
std::string simulation_text(const Table& table);

} // namespace dss
