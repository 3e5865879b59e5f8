#pragma once
/// The two ways in which a user's run ends early. what() is one line: what, where and what would be right.
#include <stdexcept>
#include <string>

namespace dss {

/// Bad input: exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A run that is, or would be, unstable: exit code 3.
struct UnstableError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace dss
