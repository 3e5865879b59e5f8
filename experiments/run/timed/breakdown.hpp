#pragma once
/// Describes a run that became non-finite.
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace dss {

/// "the state is not finite after step 12 (t = 1.2e-05 s), element 3".
/// @param what  from an Outcome or Breakdown
/// @param step  the failing step, counted from 0 at the start of the run
inline std::string breakdown_text(std::string_view what, long step, double dt,
                                  std::size_t element) {
  return fmt::format("{} after step {} (t = {:.6g} s), element {}", what, step + 1,
                     double(step + 1) * dt, element);
}

} // namespace dss
