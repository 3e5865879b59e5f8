#pragma once
/// Computes steps of a run once more by another variant, the witness, and compares all bits.
/// README.md beside this file says which faults that finds.
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/timed/run_result.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Refuses runs that have no guard, before anything is computed.
/// @throws InputError with the reason and what to give
void require_sound_guard(const RunRequest& request, const RunPlan& plan);

/// Guards one run. Collective: all ranks make one, and get the same answers.
class Guard {
public:
  /// @param run      the executor that computes; its variant is `variant` of its parts
  /// @param has_fma  how it rounds
  /// @throws InputError if its state cannot be compared, or the witness rounds in another way
  Guard(const RunRequest& request, const RunPlan& plan, Executor& run, const std::string& variant,
        bool has_fma);
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  /// Before a chunk of steps, and at the end of the run: begins a comparison or ends one. The first
  /// look begins one at any step.
  /// @return empty, or what differs
  std::string look(Executor& run, Model model, long step);
  /// Steps from a step to the next look, at most `most`.
  long steps_left(long step, long most) const;
  /// The run goes on from this state of an earlier step, with another model. Compares it first.
  /// @return empty, or what differs
  std::string go_back(long step, std::span<const double> state);
  /// The run begins anew.
  void forget() { end_ = none, is_first_ = true; }
  const GuardReport& report() const { return report_; }

private:
  static constexpr long none = -1;
  std::unique_ptr<Executor> created(Model model) const;
  long next_multiple(long step) const { return (step / report_.every + 1) * report_.every; }
  /// @param has_state  the witness has the state of the run
  void begin(Executor& run, Model model, long step, bool has_state);
  /// Gives the witness the state of the run.
  void copy(Executor& run);
  /// Computes the steps since the witness got its state. @return empty, or why it could not
  std::string advance_witness(long step);
  std::string compare(Executor& run, long step);
  /// @param width  numbers of an element
  /// @param first  the first element
  std::string difference_of(std::span<const double> of_run, std::span<const double> of_witness,
                            std::size_t width, std::size_t first, long step) const;

  const RunRequest& request_;
  const RunPlan& plan_;
  const Plugin* plugin_ = nullptr;
  Distribution distribution_; ///< with the witness as the variant of parts
  Model model_ = Model::spatial;
  std::unique_ptr<Executor> witness_;
  bool is_first_ = true;                    ///< the next look begins a comparison
  long begin_ = 0;                          ///< step of the witness's state
  long end_ = none;                         ///< step at which both are compared
  std::size_t width_;                       ///< numbers of an element
  std::vector<double> of_run_, of_witness_; ///< pieces of the states
  GuardReport report_;
};

} // namespace dss
