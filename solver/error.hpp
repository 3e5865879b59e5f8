#pragma once
/// Errors that end a user's run early. what() is one line: what is wrong, where, and what would be
/// right.
#include <stdexcept>
#include <string>

namespace dss {

/// Bad input. The program exits with code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A run that is unstable, or is predicted to be. The program exits with code 3.
struct UnstableError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace dss
