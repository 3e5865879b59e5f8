#pragma once
/// Advice as text and as JSON.
#include "experiments/run/advise/advice.hpp"
#include "experiments/run/advise/grid_advice.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// A candidate as text: "planar, velocity_verlet, f32, 1200 steps of 1e-06 s".
std::string describe(const Workbench& bench, const Candidate& candidate);

/// The scene that the advice is about.
struct AdvisedScene {
  std::string scene, set; ///< scene as the user gave it; overrides as --set options, or empty
  std::string name;
  std::size_t elements = 0;
};

/// Command line that runs the configuration, to be copied.
std::string command_line(const AdvisedScene& scene, const Workbench& bench,
                         const Configuration& configuration);

/// The advice as a table and some lines.
/// @param is_verbose  true: lists every candidate and the reason against it
std::string advice_text(const AdvisedScene& scene, const AdviseRequest& request,
                        const Workbench& bench, const Advice& advice, bool is_verbose);
nlohmann::ordered_json advice_json(const AdvisedScene& scene, const AdviseRequest& request,
                                   const Workbench& bench, const Advice& advice);

/// Text about the grids that --vary tried.
std::string grid_text(const std::string& parameter, const GridAdvice& grid);
nlohmann::ordered_json grid_json(const std::string& parameter, const GridAdvice& grid);

} // namespace dss
