#pragma once
/// Output files of a run, with the stress of each element recovered.
#include "solver/io/vtu.hpp"

#include <string>
#include <vector>

namespace dss {

/// State as CSV (solver/io/state_csv.hpp).
void write_state(const std::string& path, const Problem& problem, const std::vector<double>& state, Rotation equations);

/// The .vtu of a run, or a series of them with its .pvd index: F.vtu becomes F_0000.vtu, F_0001.vtu, ... and F.pvd.
class FrameSeries {
public:
  FrameSeries(std::string output, bool is_series) : output_(std::move(output)), is_series_(is_series) {}
  /// Writes a state at a time [s]; nothing without an output.
  void add(const Problem& problem, const std::vector<double>& state, Rotation equations, double time);
  /// Writes the index of a series. @return what was written, in words; empty without an output
  std::string finish() const;
  /// Removes what was written.
  void discard();

private:
  std::string output_;
  bool is_series_;
  std::vector<Frame> frames_;
};

} // namespace dss
