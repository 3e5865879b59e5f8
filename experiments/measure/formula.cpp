#include "experiments/measure/formula.hpp"
#include "solver/error.hpp"

#include <fmt/format.h>

namespace dss {

Formula::Formula(const Node& node) : place_(node.where()) {
  const std::string text = node.is_string() ? node.text() : "";
  if (!node.json().is_number() && !(text.starts_with("=") && text.size() > 1))
    node.fail(node.shown() + " is not a number or an expression \"=...\"");
  text_ = text.empty() ? node.json().dump() : text.substr(1);
}

Formula::Formula(ObjectNode& object, const std::string& key) {
  if (const auto node = object.find(key)) *this = Formula(*node);
}

double Formula::operator()(const Parameters& parameters) const {
  try {
    return evaluate(text_, parameters);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place_, error.what()));
  }
}

std::vector<Formula> formulas(const Node& node) {
  std::vector<Formula> all;
  for (const Node& item : node.list()) all.emplace_back(item);
  return all;
}

} // namespace dss
