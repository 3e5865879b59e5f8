#pragma once
/// The history of a run: a table over time of its energies, the reactions of its clamps, and what
/// its probes see.
#include "experiments/run/checkpoint/checkpoint.hpp"
#include "experiments/run/plan/probe.hpp"
#include "solver/io/file_set.hpp"
#include "solver/model/rotation.hpp"
#include "solver/model/stress/stress_field.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Rows are kept until the run has ended well; checkpoints have them, too. So the file is always
/// whole, and no other run's.
class RunHistory {
public:
  /// @param path     of the CSV file
  /// @param problem  lives longer
  RunHistory(std::string path, const Problem& problem, std::vector<Probe> probes);

  /// Adds the row of a state after `step` steps, at a time [s]. A later row of an earlier step
  /// replaces those from there on.
  /// @param signals  a row at its time (solver/numerics/signal_rows.hpp)
  void add(long step, double time, std::span<const double> state, Rotation equations,
           std::span<const double> signals);
  /// Names of the columns, with commas between them.
  std::string columns() const;
  /// The rows so far, for a checkpoint.
  HistoryRows kept() const { return {columns(), numbers_}; }
  /// Goes on with the rows of a checkpoint. The row of its run's end is left out if it does not fit
  /// the interval of those before it.
  /// @throws InputError if they have other columns
  void go_on(const HistoryRows& rows);
  void clear() { numbers_.clear(); }
  /// Lets go of what adding a row needs, about 400 bytes an element.
  void release() { field_.reset(); }
  /// Adds the file to those of a run that has ended.
  void write(FileSet& outputs) const;

  /// Where each probe is, and what it sees in the last row: one line each.
  std::vector<std::string> probe_texts() const;

private:
  /// What a probe sees.
  struct Sight {
    Vec3 displacement{}, velocity{};
    SymmetricTensor stress{};
  };
  Sight sight(const Probe& probe, std::span<const double> state) const;
  std::size_t width() const; ///< numbers of a row
  /// Of the n-th row from the end.
  double step(std::size_t n) const { return *(numbers_.end() - std::ptrdiff_t((n + 1) * width())); }

  std::string path_;
  const Problem& problem_;
  std::vector<Probe> probes_;
  std::optional<StressField> field_; ///< of the equations of the last row
  Rotation equations_ = Rotation::quaternion;
  std::vector<double> numbers_; ///< row after row; the first is the step
  std::vector<Sight> last_;     ///< of each probe
};

} // namespace dss
