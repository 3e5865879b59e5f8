#pragma once
/// Checkpoints: where a run stands. A run that continues from one computes the bits of a run that
/// was never interrupted, with any number of threads and ranks, any decomposition and any variant
/// that rounds alike. README.md beside this file has the format.
#include "experiments/run/plan/run_plan.hpp"
#include "solver/io/block_file.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Where the checkpoint before the last is kept: `run.ckpt.previous`.
std::string earlier_checkpoint(const std::string& path);

/// A whole number of a head. @return -1 if it is none from 0 to 1e15
long whole_number(const nlohmann::json& value);

/// The rows of a run's history.
struct HistoryRows {
  std::string columns;         ///< their names; empty without a history
  std::vector<double> numbers; ///< row after row
};

/// What a checkpoint has beside the numbers of elements.
struct Standing {
  long step = 0;                  ///< steps done; with adaptive steps, those that were accepted
  Model model = Model::spatial;   ///< that computes
  std::vector<double> steps_kept; ///< of adaptive steps (AdaptiveSteps::each_kept), else empty
  std::vector<double> watch_kept; ///< of the watch over a model, or empty
  HistoryRows history;
};

/// The run, or the ensemble, that a checkpoint belongs to: what must agree so that bits do.
struct RunIdentity {
  /// @param is_watched  the error of a small model is watched (ModelMonitor)
  RunIdentity(const RunRequest& request, const RunPlan& plan, bool is_watched, bool has_fma,
              int kept_fields, std::span<const long> stops);
  /// @throws InputError if the file's head is of another run; the line names what differs and what
  /// to give
  void require_same(const std::string& path, const nlohmann::json& head) const;
  nlohmann::ordered_json facts; ///< name -> value
};

/// A checkpoint that the root writes. Others wait for it. After a failure they go on, because
/// saving elements is collective.
class CheckpointFile {
public:
  CheckpointFile(std::string path, const nlohmann::ordered_json& head, Executor& executor,
                 bool is_root);
  void write(std::span<const double> numbers);
  /// Moves it to its place, and the one before to earlier_checkpoint().
  /// @return one line if the root could not write it, else empty
  std::string commit();

private:
  template <class Act>
  void try_to(Act&& act);

  std::string path_;
  Executor& executor_;
  bool is_root_;
  std::optional<BlockWriter> file_;
  std::string failure_;
};

/// Writes a checkpoint. Collective: all ranks give their elements, the root writes.
/// @return one line if the root could not write it, or if a number is not finite, so that the run
/// is about to fail; an earlier checkpoint then stands. Else empty
std::string write_checkpoint(const std::string& path, const RunIdentity& identity,
                             const Standing& standing, Executor& executor, std::size_t elements,
                             bool is_root);

/// Reads a checkpoint.
class SavedRun {
public:
  /// Reads all but the elements. @throws InputError if the file is none or is damaged
  explicit SavedRun(std::string path);
  const Standing& standing() const { return standing_; }
  /// @throws InputError as RunIdentity::require_same
  void require_same(const RunIdentity& identity) const {
    identity.require_same(path_, reader_.head());
  }
  /// Gives each executor its elements. Collective.
  /// @throws InputError if a block is damaged
  void restore(Executor& executor, std::size_t elements);

private:
  std::string path_;
  BlockReader reader_;
  Standing standing_;
};

} // namespace dss
