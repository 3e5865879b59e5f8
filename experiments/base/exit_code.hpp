#pragma once
/// Exit codes of the program (DESIGN.md section 7).
#include <array>

namespace dss {

/// The codes, and their meaning in the same order.
enum ExitCode { exit_success = 0, exit_check_failed = 1, exit_bad_input = 2, exit_unstable = 3 };
inline constexpr std::array exit_code_meanings = {"success", "a check failed", "bad input",
                                                  "a run is or would be unstable"};

} // namespace dss
