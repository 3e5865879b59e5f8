#pragma once
/// `dssbench advise`: the cheapest way to run a scene within a tolerance, by short trials.
#include "experiments/runner/advise/reference_run.hpp"
#include "experiments/runner/advise/workbench.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dss {

struct AdviseRequest {
  double tolerance = 1e-4; ///< of the error by measure_of(quantity)
  Quantity quantity = Quantity::displacement;
  std::optional<double> budget_s; ///< of all trials [s]; default: least_budget_s, or budget_share times the paper's run
  int most_threads = 1;           ///< tried
  std::vector<std::string> variants; ///< tried; empty: all of the CPU that can run here
};
inline constexpr double least_budget_s = 10, budget_share = 3;

/// A model, method and precision, with the largest step that meets the tolerance.
struct Candidate {
  enum class Status { meets, costs_more, stalls, no_model, unstable, out_of_budget };
  Configuration configuration;
  Status status = Status::costs_more;
  double error =
      0; ///< measured against the reference; of the last step tried where none meets the tolerance; 0: never run
  double time_s = 0;     ///< of the whole run: predicted from timed steps, of finalists measured
  bool is_timed = false; ///< as a whole
  std::string reason;    ///< why it is not chosen
};

/// Of the published work: spatial, rk4, f64, at the scene's own step, on the variant and threads that are fastest here.
struct PaperRun {
  Configuration configuration;
  double dt = 0;     ///< the scene's, shortened where it does not divide the time between saved times [s]
  double time_s = 0; ///< measured, or from timed steps where it would take longer than a trial may
  bool is_timed = false;
  std::optional<double> error;
  std::string reason; ///< why there is no error, or empty
};

struct Advice {
  std::string failure;        ///< empty, or why nothing is chosen
  double least_tolerance = 0; ///< that could be met, where the failure knows it
  Candidate chosen;
  double error_estimate = 0;         ///< measured against the reference, and the reference's own added
  std::vector<Candidate> candidates; ///< all others, by time
  std::vector<std::pair<Model, std::string>> left_out; ///< models that lack what moves, and why
  PaperRun paper;
  ReferenceRun reference;
  double spent_s = 0; ///< on all trials
};

/// @param note  is told what is tried; may be empty
/// @throws InputError for a tolerance that is not positive and a variant that cannot run; UnstableError where no step is stable
Advice advise(const Problem& problem, const SavedTimes& times, const AdviseRequest& request,
              const std::function<void(const std::string&)>& note = {});

constexpr std::string_view name(Candidate::Status status) {
  constexpr std::array<std::string_view, 6> names{"meets the tolerance", "costs more", "error stays",
                                                  "model errs",          "unstable",   "no time to try"};
  return names[std::size_t(status)];
}

} // namespace dss
