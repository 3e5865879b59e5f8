#pragma once
/// Numbers of a study that may be expressions over a scene's parameters, as in scenes: 0.01 or
/// "=sqrt(k/m)".
#include "experiments/measure/study_sets.hpp"
#include "solver/scene/scene_text.hpp"

#include <string>
#include <vector>

namespace dss {

/// A number, or an expression that is evaluated with the parameters of a scene.
class Formula {
public:
  Formula() = default;
  /// @throws InputError with the file, the JSON pointer and the mistake
  explicit Formula(const Node& node);
  /// Reads a key of an object; is not present if the key is missing.
  Formula(ObjectNode& object, const std::string& key);
  bool is_present() const { return !text_.empty(); }
  /// Evaluates the expression.
  /// @throws InputError with the place if the expression is wrong or its value is not finite
  double operator()(const Parameters& parameters) const;

private:
  std::string text_, place_; ///< the expression, and its place in the file
};

/// Reads one value or a list of values.
std::vector<Formula> formulas(const Node& node);

} // namespace dss
