#pragma once
/// How a run that went wrong is told of.
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace dss {

/// "the state is not finite after step 12 (t = 1.2e-05 s), element 3".
/// @param what  of an Outcome or Breakdown  @param step  the failing one, counted from 0 from the start of the run
inline std::string breakdown_text(std::string_view what, long step, double dt, std::size_t element) {
  return fmt::format("{} after step {} (t = {:.6g} s), element {}", what, step + 1, double(step + 1) * dt, element);
}

} // namespace dss
