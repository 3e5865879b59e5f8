#pragma once
/// Numbers of a study that may be expressions over a scene's parameters, as in scenes: 0.01 or "=sqrt(k/m)".
#include "experiments/runner/study_sets.hpp"
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

} // namespace dss
