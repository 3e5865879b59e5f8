#pragma once
/// Input and output of `dssbench advise`.
#include "experiments/run/advise/reference_run.hpp"
#include "experiments/run/advise/workbench.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// What the user asks for.
struct AdviseRequest {
  double tolerance = 1e-4; ///< of the error that measure_of(quantity) defines
  Quantity quantity = Quantity::displacement;
  /// Time for all trials [s]. Default: least_budget_s, or budget_share times the paper's run if
  /// that is more.
  std::optional<double> budget_s;
  int most_threads = 1; ///< largest number of threads that is tried
  /// variants that are tried; empty: all variants of this CPU that can run here
  std::vector<std::string> variants;
};
inline constexpr double least_budget_s = 10, budget_share = 3;

/// A model, method and precision with the largest step that meets the tolerance.
struct Candidate {
  enum class Status { meets, costs_more, stalls, no_model, unstable, out_of_budget };
  Configuration configuration;
  Status status = Status::costs_more;
  /// Error measured against the reference. If no step meets the tolerance, that of the last step
  /// tried. 0: never run.
  double error = 0;
  /// Time of the whole run: predicted from timed steps, or measured in the final round.
  double time_s = 0;
  bool is_timed = false; ///< time_s was measured on whole runs
  std::string reason;    ///< reason why it is not chosen
};

/// The configuration of the published work: spatial, rk4, f64, with the scene's own step, on the
/// fastest variant and number of threads here.
struct PaperRun {
  Configuration configuration;
  /// Step [s]: the scene's, shortened if it does not divide the time between saved times.
  double dt = 0;
  double time_s = 0; ///< measured, or predicted from timed steps if a run would exceed the budget
  bool is_timed = false;
  std::optional<double> error;
  std::string reason; ///< reason why there is no error, or empty
};

/// The chosen configuration and everything that was tried.
struct Advice {
  std::string failure; ///< reason why nothing is chosen; empty if something is
  /// smallest tolerance that can be met, if a failure revealed it; else 0
  double least_tolerance = 0;
  Candidate chosen;
  double error_estimate = 0;         ///< measured error plus the reference's own error
  std::vector<Candidate> candidates; ///< all other candidates, by time
  /// models that lack a degree of freedom of the scene, with the reason
  std::vector<std::pair<Model, std::string>> left_out;
  PaperRun paper;
  ReferenceRun reference;
  double spent_s = 0; ///< for all trials
};

constexpr std::string_view name(Candidate::Status status) {
  constexpr std::array<std::string_view, 6> names{
      "meets the tolerance", "costs more", "error stays",
      "model errs",          "unstable",   "no time to try"};
  return names[std::size_t(status)];
}

} // namespace dss
