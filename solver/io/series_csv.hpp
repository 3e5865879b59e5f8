#pragma once
/// Time series from CSV files.
#include <string>
#include <vector>

namespace dss {

/// One column of a series over time.
struct Series {
  std::vector<double> times; ///< ascending [s]
  std::vector<double> values;
  std::string unit; ///< of the values, as the file says; empty if it does not
};

/// Reads a column of a file like
///     t [s],ax [m/s^2],az [m/s^2]
///     0,0,0.1
///     0.01,0.02,0.3
/// The first column is the time in s. Lines that begin with # are comments.
/// @param column  its name, without the unit
/// @throws InputError with file and line: a file that cannot be read or has no such column, a unit
///     of the time that is not s, a value that is missing or no number, times that do not ascend, a
///     gap (an interval more than 10 times the median)
Series read_series(const std::string& path, const std::string& column);

} // namespace dss
