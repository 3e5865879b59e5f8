#include "experiments/measure/study_names.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>

namespace dss {

const VariantStatus& known_variant(const std::string& name, const Node& node) {
  std::vector<std::string> names;
  for (const VariantStatus& status : variants()) {
    if (status.name == name) return status;
    names.push_back(status.name);
  }
  node.fail(fmt::format("unknown variant \"{}\"; {}", name, nearest_name(name, names)));
}

Model model_in(const Node& node) { return *find_model(node.known_name("model", model_names())); }

Precision precision_in(const Node& node) {
  return *find_precision(node.known_name("precision", names_of("PRECISION")));
}

std::vector<std::string> platforms_in(const Node& node) {
  const std::vector<std::string> names = node.names();
  for (const std::string& name : names) node.placed([&] { Platform::require_known(name); });
  return names;
}

Field field_in(const Node& node) {
  return Field(node.choice("field", {field_names.begin(), field_names.end()}));
}

} // namespace dss
