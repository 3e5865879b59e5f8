#include "experiments/measure/formula.hpp"

#include <fmt/format.h>

namespace dss {

Formula::Formula(const JsonPlace& place) {
  const nlohmann::json& value = place.value();
  const std::string text = value.is_string() ? value.get<std::string>() : "";
  if (!value.is_number() && !(text.starts_with("=") && text.size() > 1))
    place.fail(fmt::format("{} is not a number or an expression \"=...\"", value.dump()));
  text_ = value.is_number() ? value.dump() : text.substr(1);
  place_ = place.where();
}

double Formula::operator()(const Parameters& parameters) const {
  try {
    return evaluate(text_, parameters);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place_, error.what()));
  }
}

std::vector<Formula> formulas(const JsonPlace& place) {
  std::vector<Formula> all;
  for (const JsonPlace& item : place.items()) all.emplace_back(item);
  if (all.empty()) place.fail("is empty; give at least one number");
  return all;
}

} // namespace dss
