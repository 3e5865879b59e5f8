#pragma once
/// A study of statics: the same scenes at rest by every solver, against Newton's (experiments/README.md describes the JSON).
#include "experiments/runner/records.hpp"
#include "solver/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A scene at full loads, and at a share of them at which its equations are linear to below the bar.
struct StaticsCase {
  std::string scene;
  std::vector<Override> set;
  double small_loads = 1e-6;
  bool settles = false; ///< also by relaxation with the scene's masses, and by a damped run in time
};

struct StaticsStudy {
  std::string name, title;
  std::string variant = "auto";   ///< of explicit steps
  double bar = 1e-8;              ///< of displacements against Newton's, largest difference over largest displacement
  std::vector<StaticsCase> cases; ///< of the scale
};

/// Nothing if the study has no key "statics". @throws InputError: file, JSON pointer, what is wrong
std::optional<StaticsStudy> load_statics(const std::string& study, const std::string& scale);

/// A row for each case, loads and solver. `status`: passed, failed, or linear where linear equations are not meant to suffice.
Table statics_table(const StaticsStudy& study);
std::string statics_text(const StaticsStudy& study, const Table& table);

/// Largest difference of a displacement against the largest displacement.
double displacement_difference(const std::vector<double>& state, const std::vector<double>& reference);

} // namespace dss
