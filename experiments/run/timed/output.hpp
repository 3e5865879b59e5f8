#pragma once
/// Output files of a run. They include the stress of each element, recovered from the state.
#include "experiments/base/clock.hpp"
#include "experiments/run/plan/run_request.hpp"
#include "solver/io/file_set.hpp"
#include "solver/io/vtk/vtkhdf.hpp"
#include "solver/io/vtk/vtu.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Names of the files of a run's final state: a CSV (solver/io/state_csv.hpp) and a picture
/// (solver/io/picture), as far as they are asked for.
std::vector<std::string> final_files(const RunRequest& request);

/// Adds them to the files of the run. The picture has the von Mises stress at the nodes, on the
/// deformed body. Displacements are magnified so that the largest is a twentieth of the body's
/// extent, unless they are larger.
/// @param signals  a row at its time (solver/numerics/signal_rows.hpp)
void write_final_files(FileSet& outputs, const RunRequest& request, const Problem& problem,
                       const std::vector<double>& state, Rotation equations,
                       std::span<const double> signals);

/// The .vtu file of a run, one of its set of files. A series has several files and a .pvd index:
/// F.vtu becomes F_0000.vtu, F_0001.vtu, ... and F.pvd, each of which appears at once. F.vtkhdf has
/// all states of a series, and appears with the other files of the run.
class FrameSeries {
public:
  /// @param outputs  files of the run; lives longer
  FrameSeries(std::string output, bool is_series, FileSet& outputs)
      : output_(std::move(output)), is_series_(is_series), outputs_(&outputs) {}
  /// Writes the state at a time [s]; signals as in write_final_files, empty: without loads. The
  /// index of a series so far is at most a second older. Does nothing without an output.
  void add(const Problem& problem, const std::vector<double>& state, Rotation equations,
           std::span<const double> signals, double time);
  /// Goes on with a series whose frames at these times [s] were written before.
  /// @throws InputError if one of them is missing
  void go_on(const std::vector<double>& times);
  /// Writes the index of a series. @return the written files as text; empty without an output
  std::string finish() const;
  /// From now on, a frame that cannot be written does not remove those before: the run can go on.
  void keep_finished() { keeps_finished_ = true; }
  /// Removes the written files of a series, or takes the single file out of the set.
  void discard();

private:
  bool is_one_file() const { return output_.ends_with(".vtkhdf"); }
  std::string index() const;
  std::string next_file() const;
  void keep_index();

  std::string output_;
  bool is_series_;
  FileSet* outputs_;
  bool keeps_finished_ = false;
  std::vector<Frame> frames_;
  std::shared_ptr<VtkHdfFile> whole_; ///< of a series in one file
  Clock::time_point indexed_;
};

} // namespace dss
