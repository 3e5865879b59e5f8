#pragma once
/// VTKHDF output: all states of a series in one HDF5 file, with the bodies once. ParaView 5.12 and
/// later read it.
#include "solver/io/atomic_file.hpp"
#include "solver/io/vtk/stress_output.hpp"
#include "solver/model/problem.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// A file under construction. HDF5 writes a temporary file beside the target; copy_to() gives its
/// bytes to a file that appears with the others of a run.
class VtkHdfFile {
public:
  /// @throws InputError if it cannot be created
  explicit VtkHdfFile(std::string target);
  VtkHdfFile(const VtkHdfFile&) = delete;
  VtkHdfFile& operator=(const VtkHdfFile&) = delete;
  ~VtkHdfFile();

  /// Adds a state, with the arrays of write_vtu. @throws InputError if it cannot be written
  void add(const Problem& problem, double time, std::span<const double> state,
           const StressOutput& stress);
  /// Writes the times and copies all to a file, which its caller commits. @throws InputError
  void copy_to(AtomicFile& file);

private:
  using Handle = std::int64_t; ///< hid_t of HDF5
  void write_bodies(const Problem& problem, const StressOutput& stress);
  void write_steps();
  [[noreturn]] void fail(const char* what) const;

  std::string target_, temporary_;
  Handle file_ = -1;
  std::vector<double> times_;
  std::size_t points_ = 0, cells_ = 0, bodies_ = 0;
  std::vector<std::string> point_arrays_, cell_arrays_; ///< their names in the file
};

} // namespace dss
