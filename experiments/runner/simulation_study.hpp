#pragma once
/// The part of a study that is simulated: its cells, and the table in which published, measured and simulated times have
/// columns of their own (experiments/README.md describes the JSON).
#include "experiments/runner/records.hpp"
#include "experiments/runner/study_reader.hpp"
#include "solver/scene/scene.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A published speed of a node.
struct PublishedNode {
  double wall_s = 0, elements = 0, steps = 0;
};

/// Every combination of these is simulated, once with the published node and once with one core of this machine.
struct SimulationBlock {
  std::string label, scene;
  std::vector<std::vector<Override>> sets;           ///< or, for weak scaling, ...
  std::map<int, std::vector<Override>> set_of_ranks; ///< ... one for each number of ranks
  std::vector<int> ranks;
  std::vector<std::string> platforms, halos, decompositions;
  long steps = 0;                         ///< of the problem: times are given for so many
  std::optional<PublishedNode> published; ///< absent: our node alone
  std::map<int, double> paper_wall_s;     ///< published, by ranks
};

/// Key "simulation" of a study file or name, one block or a list; empty if it simulates nothing. A scale may limit
/// `most_ranks` and `most_elements`, and leave out blocks by their labels. Everything is checked before anything is simulated.
/// @throws InputError: file, JSON pointer, what is wrong
std::vector<SimulationBlock> load_simulation(const std::string& study, const std::string& scale);
/// Name of a study that has nothing to measure; else empty.
std::string name_if_simulated_only(const std::string& study);

/// Simulates all blocks. @param measured  the study's own table, whose times on ranks are put beside the simulated; may be empty
Table simulate_study(const std::string& study, const std::vector<SimulationBlock>& blocks, const Table& measured);

/// The table for people.
std::string simulation_text(const Table& table);

} // namespace dss
