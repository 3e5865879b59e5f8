#pragma once
/// Numbers of a study that may be expressions over a scene's parameters, as in scenes: 0.01 or "=sqrt(k/m)".
#include "experiments/runner/study_reader.hpp"
#include "solver/scene/json/document.hpp"

#include <string>
#include <vector>

namespace dss {

class Formula {
public:
  Formula() = default;
  /// @throws InputError: file, JSON pointer, what is wrong
  explicit Formula(const JsonPlace& place);
  bool is_present() const { return !text_.empty(); }
  /// @throws InputError that names the place if the expression is wrong or its value is not finite
  double operator()(const Parameters& parameters) const;

private:
  std::string text_, place_; ///< expression, and where it stands
};

/// One value or several.
std::vector<Formula> formulas(const JsonPlace& place);

/// Overrides of a scene, key by key one value or several: every combination of them.
/// "set": {"n": [4, 8], "E": 1e7} -> {n=4, E=1e7}, {n=8, E=1e7}; {} without the key
std::vector<std::vector<Override>> combinations(const JsonPlace& object, const std::string& key);

/// File of a scene that a study names: beside the study if it ends in .json, else a shipped one's name.
std::string scene_beside(const std::string& study_path, const std::string& scene);

} // namespace dss
