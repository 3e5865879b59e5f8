#pragma once
/// The resolved constants of a scene's links, as `explain` shows them.
#include "solver/model/problem.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace dss {

/// Links with the same constants.
struct LinkSummary {
  std::string body; ///< or "(extra links)"
  int axis = 0;
  std::size_t count = 0;
  AxisConstants constants;
};

/// All links of a problem, by body, axis and kind; then the extra links.
std::vector<LinkSummary> summarize_links(const Problem& problem);

/// Elements with the same pressure.
struct PressureSummary {
  std::string body;
  std::size_t count = 0;
  ElementPressure constants;
};
/// Of all bodies that have pressures, by body and kind.
std::vector<PressureSummary> summarize_pressures(const Problem& problem);
nlohmann::ordered_json pressures_json(const std::vector<PressureSummary>& pressures);
std::string pressures_text(const std::vector<PressureSummary>& pressures);

/// One object each; units are in the names of the keys.
nlohmann::ordered_json links_json(const std::vector<LinkSummary>& links);

/// A table for people of the stiffnesses.
std::string links_text(const std::vector<LinkSummary>& links);

} // namespace dss
