#pragma once
/// The schedule "stage by stage". It serves adaptive steps, parts whose halo is exchanged after
/// every stage, and extra links that join rows of parts or of distant blocks. Every stage keeps all
/// rows. The threads of a team meet twice in a stage, and once more after pressures.
#include "variants/api/api.hpp"
#include "variants/api/halo.hpp"
#include "variants/engine/extra_links.hpp"
#include "variants/engine/step_error.hpp"
#include "variants/engine/wavefront.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

namespace dss {

/// @param why  the schedule has no tiles
/// @throws InputError if one was asked for
void refuse_tile(const Setup& setup, std::string_view why);

/// All rows of the state and of every intermediate stage, and the steps over them.
template <class T, int W = simd::lanes<T>>
class StagedRows {
public:
  /// @param dt        step [s]
  /// @param exchange  null, or how the part exchanges its halo
  /// @param is_swapped  see is_swapped(); always true for methods of one stage. Others must not be
  ///   parts then, whose copies are the inputs of stages.
  StagedRows(PackedRows<T, W>& packed, const Method& method, double dt, const RowStorage& storage,
             int threads, const PartSetup* exchange, bool is_swapped = false);
  T* row(int r) { return stage_row(0, r); }
  /// Methods with an error stage: sets the length of the next steps [s]. A step does not change the
  /// state; its result is in the tried rows.
  void set_step(double dt) { step_ = T(dt); }
  /// Row r of the result of a tried step.
  T* tried_row(int r) { return stage_row(method_.stages - 1, r); }
  /// Row r of the estimated error of a tried step.
  T* error_row(int r) { return stage_row(method_.stages, r); }
  /// Maxima of a tried step over the rows of a thread.
  StepMaxima maxima(int thread);
  /// Makes the result of the tried step the state, in the rows of a thread.
  void accept(int thread);
  /// Row r of a copy that parts exchange. A copy is the input of a stage. A method of one stage has
  /// two: the present and the next state.
  T* copy_row(int copy, int r) { return buffer_row(std::size_t(copy), r); }
  int copies() const {
    return is_swapped()                                        ? 2
           : exchange_ != nullptr && exchange_->is_every_stage ? method_.stages
                                                               : 1;
  }
  int current_copy() const { return parity_; }
  /// Computes the calling thread's rows of one step. All threads of the team call it together. In a
  /// part, the halo of the first stage's input must have been sent before; this call sends that of
  /// the next step, unless this step is the last.
  /// @param synchronise  the barrier of the team
  template <class Synchronise>
  void step(int thread, const StepSignals<T>& signals, bool is_last_step,
            Synchronise&& synchronise);
  /// Calls visit(row, is_whole, task) for everything that a thread does in a stage, in its order.
  template <class Visit>
  void each_task(int thread, int stage, Visit&& visit) {
    for (const RowActions* rows : {&plan_[std::size_t(thread)][std::size_t(stage)].inner,
                                   &plan_[std::size_t(thread)][std::size_t(stage)].outer})
      for (const RowAction& action : *rows)
        visit(action.row, action.is_whole, task_of(thread, stage, action.row, action.is_whole));
  }
  /// The same for the pressures at the input of a stage.
  template <class Visit>
  void each_pressure_task(int thread, int stage, Visit&& visit) {
    for (const RowAction& action : plan_[std::size_t(thread)][std::size_t(stage)].pressures)
      visit(action.row, action.is_whole, pressure_task(thread, stage, action.row));
  }
  /// A row of the input of a stage, which is the output of the stage before it.
  T* stage_row(int stage, int r) {
    const bool is_state = stage == 0 || stage == method_.stages;
    if (!is_swapped_ || !is_state) return buffer_row(std::size_t(stage), r);
    return buffer_row((stage == 0) == (parity_ == 0) ? 0 : std::size_t(method_.stages), r);
  }
  /// Whether neighbours may still read the state while the last stage writes its output, as in a
  /// method of one stage. Then the output gets buffers of its own, and both swap after each step.
  bool is_swapped() const { return is_swapped_; }
  void swap() { parity_ ^= 1; }
  /// Whether parts exchange the input of a stage. copy_of() is the number of that copy.
  bool is_exchanged(int stage) const {
    return exchange_ != nullptr && (stage == 0 || exchange_->is_every_stage);
  }
  int copy_of(int stage) const { return is_swapped() ? parity_ : stage; }
  /// The least element that is not finite after a step, if there is one.
  std::optional<std::size_t> failed_element() const;
  void forget_failures() { failed_.assign(failed_.size(), std::nullopt); }
  std::size_t bytes() const;
  int threads() const { return int(cuts_.size()) - 1; }

private:
  /// What a thread does with a row in a stage: computes all of it, or only its links to those upper
  /// rows that are computed.
  struct RowAction {
    int row;
    bool is_whole;
  };
  using RowActions = std::vector<RowAction>;
  /// The rows of a thread in two groups: those that read no halo, and the others.
  struct StageRows {
    RowActions inner, outer;
    RowActions pressures; ///< at the input of the stage
  };
  T* buffer_row(std::size_t buffer, int r) {
    return stages_[buffer].data() + packed_.rows[std::size_t(r)].pack_offset * pack_size_;
  }
  template <class IsComputed>
  RowActions actions(int begin, int end, IsComputed&& is_computed) const;
  void plan_rows();
  RowTask<T> task_of(int thread, int stage, int r, bool is_whole);
  RowTask<T> pressure_task(int thread, int stage, int r);
  void compute(int thread, int stage, const StepSignals<T>& signals, const RowActions& rows);
  /// Finds the pressures at the input of a stage.
  void press(int thread, int stage, const StepSignals<T>& signals);

  PackedRows<T, W>& packed_;
  const Method& method_;
  const StepSweeps sweeps_;
  const PartSetup* exchange_;
  const bool is_swapped_;
  const int fields_;
  const std::size_t pack_size_;
  std::vector<int> cuts_;
  std::vector<std::vector<StageRows>> plan_; ///< [thread][stage]
  /// [0]: the state; [m]: the output of stage m - 1. If swapped, the first and the last are the
  /// states of both parities.
  std::vector<Buffer<T>> stages_;
  int parity_ = 0;
  std::vector<CarryRings<T>> carry_;
  std::vector<std::optional<std::size_t>> failed_; ///< of each thread
  const RowStorage storage_;
  T step_ = 1; ///< length of a step [s]; only methods with an error stage use it
  /// Lanes of own elements in each pack; only for methods with an error stage.
  std::vector<simd::LaneMask> own_lanes_;
  const std::vector<StageUpdate<T>> updates_;
  ExtraLinks<T, W> extra_links_;
};

template <class T, int W>
template <class Synchronise>
void StagedRows<T, W>::step(int thread, const StepSignals<T>& signals, bool is_last_step,
                            Synchronise&& synchronise) {
  const auto receive = [&](int s) {
    for (const Side side : all_sides) exchange_->halo.receive(side, copy_of(s));
  };
  for (int s = 0; s < method_.stages; ++s) {
    const bool is_last = s + 1 == method_.stages;
    // Extra links and pressures may read the halo and come first.
    const bool is_hidden = is_exchanged(s) && exchange_->is_overlapped && extra_links_.empty() &&
                           !sweeps_.has_pressure;
    const StageRows& rows = plan_[std::size_t(thread)][std::size_t(s)];
    if (thread == 0 && is_exchanged(s) && !is_hidden) receive(s);
    if (thread == 0) extra_links_.evaluate([&](int r) { return stage_row(s, r); }, fields_);
    synchronise();
    if (sweeps_.has_pressure) {
      press(thread, s, signals);
      synchronise();
    }
    compute(thread, s, signals, rows.inner);
    if (is_hidden) {
      if (thread == 0) receive(s);
      synchronise();
    }
    compute(thread, s, signals, rows.outer);
    synchronise();
    if (is_last && is_swapped()) {
      if (thread == 0) swap();
      synchronise();
    }
    const int next = is_last ? 0 : s + 1;
    if (thread == 0 && is_exchanged(next) && !(is_last && is_last_step))
      for (const Side side : all_sides) exchange_->halo.send(side, copy_of(next));
  }
}

} // namespace dss
