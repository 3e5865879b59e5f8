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

/// Rows are kept until the run ends, so the file is always whole. A run that is saved keeps its
/// rows in a file beside it, F.csv.part, so that only a run that ends well replaces an earlier
/// file.
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
  /// What a checkpoint has of the rows before it.
  HistoryMark mark() const;
  /// Goes on with the rows of the run that was interrupted, from the file of a saved or an ended
  /// run.
  /// @throws InputError if no file has them
  void go_on(const HistoryMark& mark);
  void clear() { rows_.clear(); }
  /// Lets go of what adding a row needs, about 400 bytes an element.
  void release() { field_.reset(); }
  /// Adds the file to those of a run that has ended.
  void write(FileSet& outputs) const;
  /// Writes the rows so far, when the run is saved.
  /// @return one line if they cannot be written, else empty
  std::string save() const;

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
  std::string part() const { return path_ + ".part"; }
  bool take_rows(const std::string& path, const HistoryMark& mark);
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
