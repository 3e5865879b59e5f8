#pragma once
/// A run that its caller advances step by step.
#include "experiments/run/plan/run_plan.hpp"
#include "solver/model/stress/tensor.hpp"
#include "variants/api/executor.hpp"

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// One scene on one variant, in this process. The caller decides how far it goes, and may look at
/// the state and set it in between. It is neither timed nor judged: `dssbench run` does that.
class Simulation {
public:
  /// Starts at the initial state of the scene.
  /// @param request  for one process; files of outputs are ignored
  /// @throws InputError, UnstableError as run_scene; InputError for several ranks, adaptive steps,
  ///     ensembles and a model whose error would have to be watched
  explicit Simulation(RunRequest request);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Advances by some steps. The step after the scene's last one is as good as any other. If a step
  /// fails, nothing but set_state() helps.
  /// @throws UnstableError if a step fails, and at every later call
  /// @throws InputError as require_possible, and if another thread is in advance()
  void advance(long steps);
  /// @throws InputError for a negative number, and beyond the end of a series that drives the scene
  /// @throws UnstableError after a step that failed
  void require_possible(long steps) const;
  /// Steps of one call of advance() after which the caller may want to look around: some 0.1 s of
  /// work. Methods with leaps take more, because leaps end with each call.
  long chunk(long most) const;

  /// The present state, field_count numbers an element (kernels/fields.hpp). The place in memory is
  /// the same for the whole life of this object; the numbers are current until the next advance().
  std::span<const double> state();
  /// Sets the state and restarts the method. The time goes on.
  /// @throws InputError for another size, or a number that is not finite
  void set_state(std::span<const double> state);

  /// Stress in the middle of each element: xx, yy, zz, yz, xz, xy in global axes [Pa].
  std::vector<SymmetricTensor> stress();
  double energy();      ///< kinetic and elastic [J], see total_energy
  std::string digest(); ///< of the state's bits, as `dssbench run` prints it
  /// Centres of the elements at rest [m].
  std::vector<std::array<double, 3>> places() const;
  /// Draws the stress on the deformed body as SVG. @throws InputError if it cannot be written
  void write_picture(const std::string& path);

  const RunPlan& plan() const { return plan_; }
  const Problem& problem() const { return plan_.scene.problem; }
  long step() const { return step_; }
  double time() const { return double(step_) * plan_.dt; } ///< [s]
  std::string schedule() const { return executor_->schedule(); }

private:
  void advance_whole(long steps);
  [[noreturn]] void refuse_busy() const;
  Rotation equations() const;
  std::vector<double> signals() const;

  RunRequest request_;
  RunPlan plan_;
  std::unique_ptr<Executor> executor_;
  std::vector<double> state_;
  bool is_current_ = false;           ///< state_ is the executor's
  std::atomic<bool> is_busy_ = false; ///< a thread is in advance()
  long step_ = 0;
  double step_s_ = 0;     ///< time of a step [s]; 0: unknown
  std::string breakdown_; ///< why a step failed; empty if none did
};

} // namespace dss
