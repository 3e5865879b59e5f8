#pragma once
/// A cell of a study: one configuration of one scene. Its time is one figure of the study.
#include "solver/scene/scene.hpp"

#include <string>
#include <vector>

namespace dss {

/// Overrides as one text: "n=100 run.dt=1e-06".
std::string set_text(const std::vector<Override>& set);

/// One configuration that is measured. All values are resolved; `dssbench run` takes them as they
/// are.
struct Cell {
  std::string scene;
  std::vector<Override> set;
  std::string variant;
  int threads = 1; ///< threads of each rank
  int ranks = 1;
  std::string decomposition = "strips", halo = "auto"; ///< As asked for; unused on 1 rank.
  /// Device that computes, as choose_device takes it; empty: any. Of a hybrid: a device that must
  /// be present.
  std::string device;
  std::string hybrid; ///< members as parse_members reads them, or "auto"; empty: no hybrid
  std::string model, precision, integrator;
  long members = 1; ///< of an ensemble of equal ones; 1: a run alone
  double dt = 0;    ///< step [s]; 0: the scene's
  /// Relative tolerance of adaptive steps, whose first step is dt; 0: all steps are dt.
  double rtol = 0;
  long steps = 0;
  /// Steps of the whole study; `steps` is smaller if the variant is too slow for them.
  long full_steps = 0;
  bool is_twin = false;        ///< second cell of an A/A pair
  bool is_whole_once = false;  ///< one run of all steps, to check the scaling of a shorter cell
  std::string skipped;         ///< reason why it cannot run here; empty if it can
  bool is_unavailable = false; ///< skipped because a device is missing
  /// Of a weak scaling: the overrides of its cell on 1 rank, "n=100"; else empty.
  std::string weak_base_set;

  /// Overrides as one text: "n=100"; of an ensemble with its members: "ensemble=64 n=100".
  std::string set_text() const;
  /// Name of the cell, unique in a study: "plate_paper n=100 avx512 t2 spatial f64 rk4 500 steps
  /// (A/A)"; on several ranks "... avx512 r4 strips deep t1 ...".
  std::string key() const;
  /// Name of the physics and the steps. Cells with the same problem key have comparable states. It
  /// is key() without the executor (variant, device, threads, ranks, decomposition, halo) and
  /// without the mark of a twin.
  std::string problem_key() const;
  /// " dt 1e-06 s" if the cell has its own step, " rtol 1e-06" if its steps are adaptive; else
  /// empty.
  std::string step_text() const;
  /// Short text for people: "avx512, 2 threads", "avx512, 2 ranks x 1 thread, halo deep".
  std::string label() const;
  /// True with more workers (ranks x threads) than cores: the time is shown, but says nothing about
  /// speed.
  bool is_oversubscribed(int cores) const { return ranks * threads > cores; }
  /// False for a cell that is shown and has no speed-up.
  bool is_compared(int cores) const { return !is_whole_once && !is_oversubscribed(cores); }
  /// Status of a skipped cell.
  const char* skipped_status() const { return is_unavailable ? "unavailable" : "skipped"; }
};

} // namespace dss
