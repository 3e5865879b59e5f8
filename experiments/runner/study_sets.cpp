/// Overrides of a block: every combination of their values.
#include "experiments/runner/study_block.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

std::string override_text(const JsonPlace& place) {
  const nlohmann::json& value = place.value();
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  place.fail(fmt::format("{} is neither a number nor a text", value.dump()));
}

} // namespace

Sets combinations(const JsonPlace& place) {
  if (!place.value().is_object()) place.fail("is not an object of overrides, such as {\"n\": [50, 100]}");
  Sets sets(1);
  for (const auto& [key, value] : place.value().items()) {
    Sets longer;
    for (const auto& set : sets)
      for (const JsonPlace& item : place[key].items()) {
        longer.push_back(set);
        longer.back().push_back({key, override_text(item)});
      }
    sets = std::move(longer);
  }
  return sets;
}

} // namespace dss
