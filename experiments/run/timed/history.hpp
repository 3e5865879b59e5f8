#pragma once
/// The history of a run: a table over time of its energies, the reactions of its clamps, and what
/// its probes see.
#include "experiments/run/plan/probe.hpp"
#include "solver/io/file_set.hpp"
#include "solver/model/rotation.hpp"
#include "solver/model/stress/stress_field.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Rows are kept until the run ends or is saved, so the file is always whole.
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
  /// Goes on with the file of the run that was interrupted: keeps the rows of these steps.
  /// @throws InputError if it is not there, or is that of another run
  void go_on(std::span<const long> steps);
  void clear() { rows_.clear(); }
  /// Adds the file to those of a run.
  void write(FileSet& outputs) const;
  /// Writes the file at once, when the run is saved. @throws InputError if it cannot be written
  void save() const;

  /// Where each probe is, and what it sees in the last row: one line each.
  std::vector<std::string> probe_texts() const;

private:
  struct Row {
    long step = 0;
    std::string line;
  };
  /// What a probe sees.
  struct Sight {
    Vec3 displacement{}, velocity{};
    SymmetricTensor stress{};
  };
  Sight sight(const Probe& probe, std::span<const double> state) const;
  std::string header() const;
  void write(AtomicFile& file) const;

  std::string path_;
  const Problem& problem_;
  std::vector<Probe> probes_;
  std::optional<StressField> field_; ///< of the equations of the last row
  Rotation equations_ = Rotation::quaternion;
  std::vector<Row> rows_;
  std::vector<Sight> last_; ///< of each probe
};

} // namespace dss
