#include "variants/engine/wavefront.hpp"

#include "variants/engine/packs.hpp"

#include <algorithm>
#include <utility>

namespace dss {

template <class T, int W>
WavefrontStep<T, W>::WavefrontStep(PackedRows<T, W>& packed, const Method& method,
                                   std::span<const double> dt, const RowStorage& storage,
                                   std::size_t signal_count, Blocks<T, W>& blocks, int block,
                                   PassShape shape, const ExtraLinks<T, W>& extra_links)
    : packed_(packed), shape_(shape), fields_(storage.stored()), sweeps_(packed.sweeps(method)),
      pack_size_(std::size_t(fields_ * W)), blocks_(blocks), block_(block),
      has_published_(
          blocks.all().size() > 1 &&
          (is_recomputed() || blocks.all().front().is_remote() || blocks.all().back().is_remote())),
      signals_(signal_count, shape.steps * method.stages, packed.members().size()),
      updates_(stage_updates<T>(method, storage, W, dt)), extra_links_(extra_links),
      extra_wrenches_(packed, extra_links.rows()) {}

template <class T, int W>
std::vector<PassTask> WavefrontStep<T, W>::order(std::span<const SweepRows> sweeps) const {
  std::vector<PassTask> tasks = order_pass(packed_.lattice, division().order, sweeps, shape_.form,
                                           extra_links_.rows(), sweeps_);
  for (PassTask& task : tasks)
    if (computes_row(task.work) && !packed_.is_computed(task.row, sweeps_.left(task.sweep)))
      task.work = RowWork::upper_links;
  return tasks;
}

template <class T, int W>
void WavefrontStep<T, W>::make_places(const std::vector<PassTask>& order, const PassReads& reads,
                                      const Seams& seams) {
  seams_ = &seams;
  places_.emplace(packed_.lattice, division().order, order, sweep_count(), sweeps_,
                  reads.increments, reads.extra, packed_.filled.is_any(),
                  PlaceSizes{packed_.stage_sizes, packed_.links_sizes});
  // One pack more: rows look one pack ahead. Rows that no task writes are read at the first place.
  const int stages_size = std::max(places_->stage_rows_size(), packed_.max_packs) + 1;
  stage_rows_ = Buffer<T>(std::size_t(stages_size) * pack_size_, packed_.memory);
  handed_over_ =
      Buffer<T>(std::size_t(seams.handed_over_size(block_)) * pack_size_, packed_.memory);
  for (const int axis : {0, 1, 2})
    links_[std::size_t(axis)] = Buffer<T>(
        std::size_t(places_->links_size(axis)) * std::size_t(packed_.carry_size), packed_.memory);
}

template <class T, int W>
void WavefrontStep<T, W>::make_tasks(const std::vector<PassTask>& order,
                                     std::span<WavefrontStep> all) {
  all_ = all;
  find_others_rows();
  tasks_[0] = tasks_of(order, 0);
  if (others_rows_[0] != others_rows_[1]) tasks_[1] = tasks_of(order, 1);
  others_rows_ = {};
}

template <class T, int W>
void WavefrontStep<T, W>::find_others_rows() {
  const int halo = (sweep_count() + 1) * division().halo;
  for (int parity : {0, 1}) {
    std::vector<T*>& rows = others_rows_[std::size_t(parity)];
    rows.assign(packed_.rows.size(), nullptr);
    for (Block<T, W>& block : blocks_.all()) {
      const bool is_published_only = block.is_remote() || (is_recomputed() && &block != &own());
      for (int place = std::max(block.begin, own().begin - halo);
           place < std::min(block.end, own().end + halo); ++place)
        if (const int r = division().order.row(place); !is_published_only)
          rows[std::size_t(r)] = block.row(r);
        else if (block.is_published(r))
          rows[std::size_t(r)] = block.published(r, parity);
    }
  }
}

template <class T, int W>
T* WavefrontStep<T, W>::input_row(int sweep, int r, int parity) {
  if (const int stage = sweeps_.stage(sweep); stage > 0) return stage_row(stage - 1, r);
  if (sweeps_.stages == 1) {
    const int overwriting = sweeps_.of_stage(sweeps_.stage_of_pass(sweep)),
              owner = seams_->owner(overwriting, r, block_);
    if (owner > block_ && seams_->handed_over(owner, overwriting, r) != Seams::nowhere)
      return all_[std::size_t(owner)].output_row(overwriting, r);
  }
  return state_row(r, parity);
}

template <class T, int W>
auto WavefrontStep<T, W>::tasks_of(const std::vector<PassTask>& order, int parity)
    -> std::vector<RowStage> {
  std::vector<RowStage> tasks;
  tasks.reserve(order.size());
  for (const PassTask& what : order) {
    if (what.is_extra()) {
      tasks.push_back(extra_task(what, parity));
      continue;
    }
    const int r = what.row, s = sweeps_.stage(what.sweep);
    const bool is_last = s + 1 == sweeps_.stages;
    RowStage stage{what.work, what.sweep, r, false, packed_.rows[std::size_t(r)].kernels, {}};
    set_row(stage.task, packed_, r, fields_, SweepLinks{*this, what.sweep},
            [&](int row) { return input_row(what.sweep, row, parity); });
    stage.task.signals = signals_.stage(sweeps_.stage_of_pass(what.sweep));
    if (what.work == RowWork::pressure) stage.task.out = input_row(what.sweep, r, parity);
    if (const Applied<T>* applied = extra_wrenches_.applied(r)) stage.task.applied = applied;
    if (what.work == RowWork::stage) {
      T* const base = state_row(r, parity);
      stage.is_published =
          is_last && has_published_ && answers_for(r) && blocks_.of(r).is_published(r);
      if (sweeps_.stages == 1 && seams_->handed_over(block_, what.sweep, r) != Seams::nowhere)
        stage.kept = output_row(what.sweep, r);
      updates_[std::size_t(s)].set(stage.task, base, is_last ? base : stage_row(s, r),
                                   [&](int m) { return stage_row(m, r); });
    }
    tasks.push_back(stage);
  }
  plan_fetches(order, parity, tasks);
  return tasks;
}

template <class T, int W>
auto WavefrontStep<T, W>::extra_task(const PassTask& what, int parity) -> RowStage {
  RowStage stage{what.work, what.sweep, what.row, false, nullptr, {}};
  if (what.work == RowWork::extra_sum) {
    stage.row = extra_links_.index_of(what.row);
    stage.task.out = extra_wrenches_.wrench(what.row);
    return stage;
  }
  const LinkedRows& rows = extra_links_.rows()[std::size_t(what.row)];
  stage.task.in = input_row(what.sweep, rows.i, parity);
  stage.task.base = input_row(what.sweep, rows.j, parity);
  return stage;
}

template <class T, int W>
void WavefrontStep<T, W>::watch(int row, std::function<void()> done) {
  const std::vector<RowStage>& all = tasks_[0];
  const bool is_known = std::exchange(watched_row_, row) == row;
  for (std::size_t n = 0; n < all.size() && !is_known; ++n)
    if (all[n].work == RowWork::stage && all[n].sweep + 1 == sweep_count() && all[n].row <= row)
      watched_task_ = std::ptrdiff_t(n);
  watched_rows_done_ = std::move(done);
}

template <class T, int W>
std::size_t WavefrontStep<T, W>::bytes() const {
  return stage_rows_.bytes() + handed_over_.bytes() + links_[0].bytes() + links_[1].bytes() +
         links_[2].bytes() + extra_links_.bytes() + extra_wrenches_.bytes() +
         (tasks_[0].size() + tasks_[1].size()) * sizeof(RowStage);
}

template <class T, int W>
void WavefrontStep<T, W>::operator()(const double* signals, int steps, int parity, long pass,
                                     std::span<Progress> progress) {
  // Sweeps that run. After a failure those up to the end of its step: earlier steps may fail too,
  // and lower rows of the same step.
  int count = steps * sweeps_.count();
  signals_.set(signals, steps * sweeps_.stages);
  const std::vector<RowStage>& all = tasks(parity);
  SeamWatch seam(*seams_, block_, pass, progress);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const RowStage& stage = all[n];
    seam.before(int(n));
    if (n + 1 < all.size()) fetch(all[n + 1]);
    if (stage.sweep < count && !compute(stage) && answers_for(stage.row) && note_failures(stage) &&
        !packed_.is_ensemble())
      count = stage.sweep + 1;
    if (stage.is_published && stage.sweep + 1 == sweep_count())
      blocks_.of(stage.row).publish(stage.row, parity ^ 1);
    seam.after(int(n));
    if (std::ptrdiff_t(n) == watched_task_) watched_rows_done_();
  }
}

template <class T, int W>
bool WavefrontStep<T, W>::note_failures(const RowStage& stage) {
  bool has_failed = false;
  for (std::size_t m = 0; m < own().failures.size(); ++m) {
    if (!packed_.is_live(int(m))) continue;
    const auto element = packed_.first_failed(stage.row, stage.task.out, fields_, int(m));
    if (!element) continue;
    own().failures[m].meet(sweeps_.step(stage.sweep), *element);
    has_failed = true;
  }
  return has_failed;
}

/// Tasks are read once a pass, so those of a large body are out of the cache by then.
template <class T, int W>
void WavefrontStep<T, W>::fetch(const RowStage& next) {
  static_assert(sizeof(RowStage) <= 7 * Memory::line);
  for (std::size_t byte = 0; byte < sizeof(RowStage); byte += Memory::line)
    simd::fetch(reinterpret_cast<const char*>(&next) + byte);
}

template <class T, int W>
bool WavefrontStep<T, W>::compute(const RowStage& stage) {
  const RowTask<T>& task = stage.task;
  const bool is_pressure = sweeps_.is_pressure(stage.sweep);
  switch (stage.work) {
  case RowWork::stage:
    if (stage.kept != nullptr)
      std::copy_n(task.base, std::size_t(task.packs) * pack_size_, stage.kept);
    return stage.kernels->stage(task);
  case RowWork::pressure:
    find_pressures(*stage.kernels, task);
    break;
  case RowWork::upper_links:
    prime_uppers(*stage.kernels, task, is_pressure);
    break;
  case RowWork::upper_link_x:
    leave_links(*stage.kernels, task, 0, is_pressure);
    break;
  case RowWork::upper_link_y:
    leave_links(*stage.kernels, task, 1, is_pressure);
    break;
  case RowWork::upper_link_z:
    leave_links(*stage.kernels, task, 2, is_pressure);
    break;
  case RowWork::extra_link:
    extra_links_.compute(stage.row, task.in, task.base, fields_);
    break;
  case RowWork::extra_sum:
    extra_links_.add_up(stage.row, task.out);
    break;
  }
  return true;
}

template <class T, int W>
Wavefront<T, W>::Wavefront(PackedRows<T, W>& packed, const Method& method,
                           std::span<const double> dt, const RowStorage& storage,
                           std::size_t signal_count, Blocks<T, W>& blocks, PassShape shape,
                           const ExtraLinks<T, W>& extra_links) {
  const RowDivision& division = blocks.division();
  const StepSweeps of_step = packed.sweeps(method);
  const int count = division.blocks(), sweeps = shape.steps * of_step.count();
  for (int b = 0; b < count; ++b)
    steps_.emplace_back(packed, method, dt, storage, signal_count, blocks, b, shape, extra_links);
  PassReads reads{of_step, {}, steps_.front().linked_rows(), packed.stage_sizes};
  for (const StageUpdate<T>& update : stage_updates<T>(method, storage, W, dt)) {
    reads.increments.emplace_back();
    for (const auto& [stage, alpha] : update.increments) reads.increments.back().push_back(stage);
  }
  auto rows = block_sweeps(division, int(packed.rows.size()), sweeps);
  std::vector<std::vector<PassTask>> orders;
  for (std::size_t b = 0; b < steps_.size(); ++b) orders.push_back(steps_[b].order(rows[b]));
  seams_.emplace(packed.lattice, division, std::move(rows), reads, orders);
  for (std::size_t b = 0; b < steps_.size(); ++b) steps_[b].make_places(orders[b], reads, *seams_);
  for (std::size_t b = 0; b < steps_.size(); ++b) steps_[b].make_tasks(orders[b], steps_);
  for (WavefrontStep<T, W>& step : steps_) step.forget_places();
  seams_->forget_outputs();
  progress_ = std::vector<Progress>(steps_.size());
}

template <class T, int W>
std::size_t Wavefront<T, W>::bytes() const {
  std::size_t sum = 0;
  for (const WavefrontStep<T, W>& step : steps_) sum += step.bytes();
  return sum;
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template class WavefrontStep<T, W>;                                                              \
  template class Wavefront<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
