#pragma once
/// A study: which cells are measured, on which scale, by which rules (experiments/README.md describes the JSON).
#include "experiments/runner/precision/precision_rules.hpp"
#include "experiments/runner/precision/saved_times.hpp"
#include "solver/scene/scene.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// What one figure is measured of. Everything definite, as `dssbench run` takes it.
struct Cell {
  std::string scene;
  std::vector<Override> set;
  std::string variant;
  int threads = 1; ///< of each rank
  int ranks = 1;
  std::string decomposition = "strips", halo = "auto"; ///< as asked for; without meaning on 1 rank
  std::string device; ///< that computes, as choose_device takes it; of a hybrid: that must be there; empty: any
  std::string hybrid; ///< members, see parse_members, or "auto"; empty: no hybrid
  std::string model, precision, integrator;
  double dt = 0;         ///< [s]; 0: the scene's
  double rtol = 0;       ///< steps adapt to this tolerance, and dt is the first that is tried; 0: all are dt
  double step_limit = 0; ///< of a cell of precision: largest stable step [s]
  SavedTimes times;      ///< at which it is compared with the solution; none in studies of speed alone
  long steps = 0;
  long full_steps = 0;         ///< of the study; `steps` is less where the variant is too slow for them
  bool is_twin = false;        ///< the second of an A/A pair
  std::string skipped;         ///< why it cannot run here, or empty
  bool is_unavailable = false; ///< skipped for want of a device
  /// Of a weak scaling: overrides of its cell on 1 rank, "n=100"; else empty.
  std::string weak_base_set;

  /// "n=100"
  std::string set_text() const;
  bool is_of_precision() const { return times.count > 0; }
  /// Unique in a study: "plate_paper n=100 avx512 t2 spatial f64 rk4 500 steps (A/A)", on ranks "... avx512 r4 strips
  /// deep t1 ..."
  std::string key() const;
  /// Cells with equal physics and steps, whose states are comparable: the key without what computes them (variant,
  /// threads, ranks and what belongs to them) and twin.
  std::string problem_key() const;
  /// " dt 1e-06 s" of one that has a step of its own, and " rtol 1e-06" of one that adapts it; else empty.
  std::string step_text() const;
  /// For people: "avx512, 2 threads", "avx512, 2 ranks x 1 thread, halo deep"
  std::string label() const;
  /// More workers than cores: shown, but no measure of speed.
  bool is_oversubscribed(int cores) const { return ranks * threads > cores; }
  /// Status of one that is skipped.
  const char* skipped_status() const { return is_unavailable ? "unavailable" : "skipped"; }
};

/// How much is measured: seconds, minutes or the paper's size.
struct Scale {
  std::string name;
  long steps = 0;
  long oracle_steps = 0; ///< the oracle is compared with after min(steps, oracle_steps) steps
  long warmup_steps = 2;
  long full_steps = 0;                      ///< that times are scaled to in columns of their own; 0: those of the cell
  std::map<std::string, long> steps_by_set; ///< other `steps` for the cells of an override text, "n=50"
  std::map<std::string, long> steps_for;    ///< fewer steps for slow variants, "scalar", or "scalar n=50" for one set
  long tail_checks = 0; ///< repetitions whose ends the oracle checks, the others must have their bits; 0: all
  long min_repetitions = 6, max_repetitions = 30;
  long retries = 3;          ///< of a contaminated repetition
  double shorten = 1;        ///< of cells of precision: end times, times this; ...
  double repeat_for = 0.1;   ///< ... runs shorter than this start again until so much was measured [s]; ...
  std::vector<int> halvings; ///< ... and in place of those of the blocks, if there are any
  double half_width = 0.02;  ///< a cell is converged at this relative half-width of its interval
  double budget_s = 240;     ///< for the whole study [s]
  double time_limit_s = 120; ///< for one repetition [s]
};

/// A published figure, beside the measured ones and never in their columns.
struct PaperRow {
  std::string label;
  double wall_s = 0, speedup = 0; ///< speedup 0: none is published
  std::string set{};              ///< overrides of the problem as a cell's text, "n=50"; may be empty
};

/// "n=100 run.dt=1e-06"
std::string set_text(const std::vector<Override>& set);

struct Study {
  std::string name, title, path;
  std::vector<std::string> bases; ///< variants that speed-ups refer to, on one rank and thread
  std::vector<Cell> cells;
  Scale scale;
  std::string paper_source;
  std::vector<PaperRow> paper;
  std::optional<PrecisionRules> precision; ///< of a study of work against precision
};

/// A study of the study directory.
struct StudyListing {
  std::string name, title, path;
};

/// Studies that this program finds: *.json in $DSSBENCH_EXPERIMENTS, else in experiments/ of the source tree.
std::vector<StudyListing> list_studies();

/// Path of a study by its name or path. @throws InputError naming the nearest
std::string study_path(const std::string& name_or_path);

/// Names of the scales of a study, by its name or path; none where there is no such study, or it has none.
std::vector<std::string> scale_names(const std::string& name_or_path);

/// Loads a study by name or path and resolves it for a scale and a number of cores.
/// Every scene is loaded with its overrides, so that a study with a wrong one is refused before it measures.
/// @throws InputError: file, JSON pointer, what is wrong and what would be right
Study load_study(const std::string& name_or_path, const std::string& scale, int cores);

} // namespace dss
