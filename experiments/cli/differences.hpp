#pragma once
/// How far two states, or two histories, are apart: files of `run --state` and `run --history`.
#include <cstddef>
#include <string>
#include <vector>

namespace dss {

/// A quantity of both files. A value is a vector; its size is the Euclidean norm.
struct Difference {
  std::string quantity, unit;
  double largest_value = 0; ///< in A
  double largest = 0;       ///< difference
  double rms = 0;           ///< difference, root mean square over the rows
  std::string place{};      ///< of the largest difference: "element 12", "t = 0.01 s"
  /// The largest difference over the largest value of A; infinite if A is zero and B is not.
  double relative() const;
};

/// Two files and what they have in common.
struct Differences {
  std::size_t rows = 0; ///< in both
  std::vector<Difference> quantities;
};

/// Compares two files of one kind. Rows of states are elements, which must stand at the same places
/// at rest. Rows of histories are times; those that only one file has are left out. Rotations are
/// compared by the vector part of the quaternion, half an angle.
/// @throws InputError with file and line: a file that is neither, other bodies, no common time, a
/// value that is no finite number
Differences differences_of(const std::string& before, const std::string& after);

} // namespace dss
