#pragma once
/// Advice for people and as JSON.
#include "experiments/runner/advise/advise.hpp"

#include "experiments/runner/advise/grid_advice.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// "planar, velocity_verlet, f32, 1200 steps of 1e-06 s": a candidate in words.
std::string describe(const Workbench& bench, const Candidate& candidate);

/// What advice is about.
struct AdvisedScene {
  std::string scene, set; ///< as given; overrides as --set options, or empty
  std::string name;
  std::size_t elements = 0;
};

/// The run as a command line, to be copied.
std::string command_line(const AdvisedScene& scene, const Workbench& bench, const Configuration& configuration);

/// @param is_verbose  with every candidate and why it was not chosen
std::string advice_text(const AdvisedScene& scene, const AdviseRequest& request, const Workbench& bench,
                        const Advice& advice, bool is_verbose);
nlohmann::ordered_json advice_json(const AdvisedScene& scene, const AdviseRequest& request, const Workbench& bench,
                                   const Advice& advice);

/// Of the grids that --vary tried.
std::string grid_text(const std::string& parameter, const GridAdvice& grid);
nlohmann::ordered_json grid_json(const std::string& parameter, const GridAdvice& grid);

} // namespace dss
