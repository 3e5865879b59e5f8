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
  /// @param run      the executor that computes; its variant is `variant`, or that of its parts
  /// @param has_fma  how it rounds
  /// @throws InputError if its state cannot be compared, or the witness rounds in another way
  Guard(const RunRequest& request, const RunPlan& plan, Executor& run, const std::string& variant,
        bool has_fma);
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  /// True if look() has something to do.
  bool is_due(long step) const { return is_end(step) || is_begin(step); }
  /// Before a chunk of steps, and at the end of the run: begins a comparison or ends one. The first
  /// look begins one at any step.
  /// @return empty, or what differs
  std::string look(Executor& run, Model model, long step);
  /// The run failed. @return empty if the witness fails in the same way, or has no state
  std::string judge_failure(Executor& run, long step, std::size_t element);
  /// The run, which is at step `next`, goes back to its state at step `good`, and on from there
  /// with another model. Compares both first. @return empty, or what differs
  std::string go_back(Executor& run, long good, std::span<const double> state, long next);
  /// Steps from a step to the next look, at most `most`.
  long steps_left(long step, long most) const;
  /// The run begins anew.
  void forget() { end_ = none, is_first_ = true; }
  /// True if all steps before this one were computed twice, or if the guard leaves some out anyway.
  bool has_checked(long step) const { return report_.steps < report_.every || sound_ == step; }
  const GuardReport& report() const { return report_; }

private:
  static constexpr long none = -1;
  bool is_end(long step) const { return end_ != none && (step == end_ || step == plan_.steps); }
  bool is_begin(long step) const {
    return step < plan_.steps && (is_first_ || step % report_.every == 0);
  }
  long next_multiple(long step) const { return (step / report_.every + 1) * report_.every; }
  /// @param has_state  the witness has the state of the run
  void begin(Executor& run, Model model, long step, bool has_state);
  std::unique_ptr<Executor> created(Model model) const;
  /// Gives the witness the state of the run.
  void copy(Executor& run);
  /// Computes up to a step. @return empty, or where the witness fails
  std::string advance_witness(long step);
  /// The same, and compares all numbers that the method keeps.
  std::string compare(Executor& run, long step);
  /// @param width  numbers of an element
  /// @param first  the first element
  std::string difference_of(std::span<const double> of_run, std::span<const double> of_witness,
                            std::size_t width, std::size_t first, long step) const;
  /// Where, and what to do.
  std::string found(long step, const std::string& what) const;
  /// The answer of all ranks: what the first of them found.
  std::string of_all(Executor& run, std::string difference) const;

  const RunRequest& request_;
  const RunPlan& plan_;
  const Plugin* plugin_ = nullptr;
  Distribution distribution_; ///< with the witness as the variant of parts
  Model model_ = Model::spatial;
  std::unique_ptr<Executor> witness_;
  bool is_first_ = true;                    ///< the next look begins a comparison
  long begin_ = 0;                          ///< step of the state that the witness got
  long at_ = 0;                             ///< step of the witness
  long end_ = none;                         ///< step at which both are compared
  long sound_ = 0;                          ///< last step at which nothing differed
  std::size_t width_;                       ///< numbers of an element
  std::vector<double> of_run_, of_witness_; ///< pieces of the states
  GuardReport report_;
};

} // namespace dss
