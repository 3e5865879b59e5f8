#pragma once
/// The request of one `dssbench run`.
#include "solver/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Options of the user. Values that are absent come from the scene.
struct RunRequest {
  std::string scene;
  std::vector<Override> overrides;
  std::string variant = "auto";
  int threads = 1;
  int ranks = 1;
  std::string decomposition = "strips", halo = "auto", shares = "equal"; ///< see Distribution
  std::string device; ///< for a variant on devices, see choose_device; empty: its first device
  std::string hybrid; ///< members, see parse_members, or "auto"; empty: no hybrid
  std::optional<std::string> model, precision, integrator, rotation;
  /// Model if neither `model` nor the scene names one: true means auto, false means spatial.
  bool is_model_auto = false;
  /// tolerance of the model's error with --model auto; absent: the scene's tolerance
  std::optional<double> model_tolerance;
  /// "promote" or "stop": action if the model's error may exceed the tolerance
  std::string on_bound = "promote";
  std::optional<double> dt; ///< [s]
  std::optional<long> steps;
  std::optional<double> rtol, atol;      ///< with rtol, steps are adaptive
  bool is_root = true;                   ///< all ranks run the same code; the root writes the files
  bool is_forced = false;                ///< run above the stability limit
  std::string ensemble;                  ///< file of members, see members_file.hpp; or empty
  bool is_member = false;                ///< it is one member of an ensemble
  std::optional<double> stability_limit; ///< limit [s] if already known; it is then not predicted
  long warmup_steps = 0;                 ///< steps before the clock starts; the state is then reset
  double warmup_s = 0;                   ///< least time of the warm-up of several workers [s]
  std::string output;                    ///< .vtu file, or empty
  int frames = 0;                        ///< files of a series besides the final one
  std::string state_csv;                 ///< file, or empty
  std::string picture;                   ///< file, or empty
  std::string history;                   ///< CSV file of the history, or empty
  std::vector<std::string> probes;       ///< of the history, see read_probe
  long every = 0;                        ///< steps between its rows; 0: by their cost
  std::string checkpoint;                ///< file that says where the run stands, or empty
  std::string checkpoint_every = "60s";  ///< see parse_checkpoint_interval
  std::string restart;                   ///< checkpoint that the run continues from, or empty
  long guard = 0;                        ///< steps between two looks of the guard; 0: no guard
  long guard_steps = 1;                  ///< of each look, computed once more
  std::string guard_variant = "auto";    ///< that computes them
  std::string json;                      ///< file, "-" for standard output, or empty
  std::string check_state;               ///< file of the oracle's state, or empty
  long check_step = 0;                   ///< step of that state
  long check_tail = 2; ///< number of last steps of a longer run that the oracle checks; 0: none
  /// file of the scene's solution, to measure errors against; or empty
  std::string reference;
  long samples = 1; ///< samples that are taken of the run, of which the fastest counts
  /// Shortest time of a sample [s]. A shorter run is repeated from the start until this time was
  /// measured.
  double repeat_for = 0;
  bool has_balance = true; ///< follow the energy
  int tile = 0;            ///< as Setup::tile; 0: as suits the caches

  /// True if the run writes checkpoints, or goes on from one.
  bool has_checkpoint() const { return !checkpoint.empty() || !restart.empty(); }
};

} // namespace dss
