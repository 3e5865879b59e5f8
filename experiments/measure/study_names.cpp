#include "experiments/measure/study_names.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>

namespace dss {

const VariantStatus& known_variant(const std::string& name, const JsonPlace& place) {
  std::vector<std::string> names;
  for (const VariantStatus& status : variants()) {
    if (status.name == name) return status;
    names.push_back(status.name);
  }
  place.fail(fmt::format("unknown variant \"{}\"; {}", name, nearest_name(name, names)));
}

Model model_in(const JsonPlace& place) {
  if (const auto model = find_model(place.text())) return *model;
  place.fail(fmt::format("unknown model \"{}\"; {}", place.text(),
                         nearest_name(place.text(), model_names())));
}

Precision precision_in(const JsonPlace& place) {
  if (const auto precision = find_precision(place.text())) return *precision;
  std::vector<std::string> names;
  for (const Precision precision : precisions) names.emplace_back(name(precision));
  place.fail(
      fmt::format("unknown precision \"{}\"; {}", place.text(), nearest_name(place.text(), names)));
}

const std::vector<std::string>& field_names() {
  static const std::vector<std::string> all = {"ux", "uy", "uz", "vx", "vy", "vz", "qs",
                                               "qx", "qy", "qz", "wx", "wy", "wz"};
  return all;
}

} // namespace dss
