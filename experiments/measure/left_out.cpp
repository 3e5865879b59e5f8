#include "experiments/measure/left_out.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {

LeftOut::LeftOut(ObjectNode& scale) : scale_(scale), labels_(scale.names_or("leave_out", {})) {}

bool LeftOut::has(const std::string& label) {
  known_.insert(label);
  return std::ranges::find(labels_, label) != labels_.end();
}

void LeftOut::require_all_known(const std::string& what) {
  for (const std::string& label : labels_)
    if (!known_.contains(label))
      scale_.require("leave_out").fail(fmt::format("no {} has the label \"{}\"", what, label));
}

} // namespace dss
