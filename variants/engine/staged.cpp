#include "variants/engine/staged.hpp"

#include "solver/error.hpp"
#include "solver/memory.hpp"
#include "variants/engine/packs.hpp"

#include <fmt/format.h>

namespace dss {

void refuse_tile(const Setup& setup, std::string_view why) {
  if (setup.tile > 0)
    throw InputError(fmt::format("--tile {}: {} has no tiles, because {}; give none", setup.tile,
                                 setup.problem.name, why));
}

template <class T, int W>
StagedRows<T, W>::StagedRows(PackedRows<T, W>& packed, const Method& method, double dt,
                             const RowStorage& storage, int threads, const PartSetup* exchange,
                             bool is_swapped)
    : packed_(packed), method_(method), sweeps_(packed.sweeps(method)), exchange_(exchange),
      is_swapped_(is_swapped || method.stages == 1), fields_(storage.stored()),
      pack_size_(std::size_t(fields_) * std::size_t(W)), cuts_(cut_rows(packed, threads)),
      failed_(cuts_.size() - 1), storage_(storage),
      updates_(stage_updates<T>(method, storage, W, {&dt, 1})), extra_links_(packed) {
  const int copies = method.stages + int(method.has_error_stage || is_swapped_);
  require_memory(double(copies) * double(packed.readable_packs() * pack_size_) * sizeof(T),
                 fmt::format("{} states, one a stage, of a body computed stage by stage", copies),
                 "give another --integrator, or a shorter --dt for faber");
  for (int m = 0; m < copies; ++m)
    stages_.emplace_back(packed.readable_packs() * pack_size_, packed.memory);
  for (std::size_t t = 0; t + 1 < cuts_.size(); ++t) carry_.emplace_back(packed);
  if (method.has_error_stage)
    own_lanes_ = own_lanes(packed, exchange == nullptr ? nullptr : &exchange->part);
  plan_rows();
}

/// The rows of [begin, end) that are computed, and the rows before them whose links they need.
template <class T, int W>
template <class IsComputed>
auto StagedRows<T, W>::actions(int begin, int end, IsComputed&& is_computed) const -> RowActions {
  const auto is_whole = [&](int r) { return r >= begin && r < end && is_computed(r); };
  RowActions list;
  for (int r = std::max(0, begin - packed_.reach); r < end; ++r) {
    const Row& row = packed_.lattice.rows[std::size_t(r)];
    if (is_whole(r) || is_whole(row.upper_y) || is_whole(row.upper_z))
      list.push_back({r, is_whole(r)});
  }
  return list;
}

template <class T, int W>
void StagedRows<T, W>::plan_rows() {
  const int rows = int(packed_.rows.size()), threads = int(cuts_.size()) - 1;
  const bool is_overlapped = exchange_ != nullptr && exchange_->is_overlapped;
  for (int t = 0; t < threads; ++t) {
    // The first and the last thread also compute those halo rows that later stages read.
    const int begin = t == 0 ? 0 : cuts_[std::size_t(t)],
              end = t + 1 == threads ? rows : cuts_[std::size_t(t) + 1];
    plan_.emplace_back();
    for (int s = 0; s < method_.stages; ++s) {
      const int left =
          exchange_ != nullptr && exchange_->is_every_stage ? 0 : sweeps_.left(sweeps_.of_stage(s));
      const auto is_computed = [&](int r) { return packed_.is_computed(r, left); };
      StageRows stage;
      if (sweeps_.has_pressure)
        stage.pressures =
            actions(begin, end, [&](int r) { return packed_.is_computed(r, left + 1); });
      if (is_overlapped)
        stage.inner =
            actions(begin, end, [&](int r) { return is_computed(r) && !packed_.reads_halo(r); });
      stage.outer = actions(begin, end, [&](int r) {
        return is_computed(r) && !(is_overlapped && !packed_.reads_halo(r));
      });
      plan_.back().push_back(std::move(stage));
    }
  }
}

template <class T, int W>
RowTask<T> StagedRows<T, W>::task_of(int thread, int stage, int r, bool is_whole) {
  RowTask<T> task;
  set_row(task, packed_, r, fields_, carry_[std::size_t(thread)],
          [&](int row) { return stage_row(stage, row); });
  if (!is_whole) return task;
  const bool is_last = stage + 1 == method_.stages && !method_.has_error_stage;
  T* const out = stage_row(is_last && !is_swapped_ ? 0 : stage + 1, r);
  updates_[std::size_t(stage)].set(
      task, stage_row(0, r), out, [&](int m) { return stage_row(m + 1, r); }, step_);
  return task;
}

template <class T, int W>
void StagedRows<T, W>::compute(int thread, int stage, const StepSignals<T>& signals,
                               const RowActions& rows) {
  for (const RowAction& action : rows) {
    const int r = action.row;
    RowTask<T> task = task_of(thread, stage, r, action.is_whole);
    if (!action.is_whole) {
      prime_uppers(*packed_.rows[std::size_t(r)].kernels, task);
      continue;
    }
    task.signals = signals.stage(stage);
    const bool is_finite = packed_.rows[std::size_t(r)].kernels->stage(task);
    if (is_finite) continue;
    std::optional<std::size_t>& failed = failed_[std::size_t(thread)];
    if (const auto element = packed_.first_failed(r, task.out, fields_))
      failed = std::min(*element, failed.value_or(*element));
  }
}

template <class T, int W>
RowTask<T> StagedRows<T, W>::pressure_task(int thread, int stage, int r) {
  RowTask<T> task = task_of(thread, stage, r, false);
  task.out = stage_row(stage, r);
  return task;
}

template <class T, int W>
void StagedRows<T, W>::press(int thread, int stage, const StepSignals<T>& signals) {
  each_pressure_task(thread, stage, [&](int r, bool is_whole, RowTask<T> task) {
    task.signals = signals.stage(stage);
    const KernelSet<T>& kernels = *packed_.rows[std::size_t(r)].kernels;
    if (is_whole)
      find_pressures(kernels, task);
    else
      prime_uppers(kernels, task, true);
  });
}

template <class T, int W>
StepMaxima StagedRows<T, W>::maxima(int thread) {
  LaneMaxima<T, W> lanes;
  for (int r = cuts_[std::size_t(thread)]; r < cuts_[std::size_t(thread) + 1]; ++r) {
    const PackedRow<T>& row = packed_.rows[std::size_t(r)];
    for (std::size_t p = 0; p < std::size_t(row.packs); ++p)
      lanes.add(error_row(r) + p * pack_size_, tried_row(r) + p * pack_size_,
                own_lanes_[row.pack_offset + p], packed_.layout.fields);
  }
  return lanes.maxima();
}

template <class T, int W>
void StagedRows<T, W>::accept(int thread) {
  for (int r = cuts_[std::size_t(thread)]; r < cuts_[std::size_t(thread) + 1]; ++r)
    accept_row(storage_, packed_.rows[std::size_t(r)].packs, W, tried_row(r), row(r));
}

template <class T, int W>
std::optional<std::size_t> StagedRows<T, W>::failed_element() const {
  std::optional<std::size_t> least;
  for (const std::optional<std::size_t>& failed : failed_)
    if (failed) least = std::min(*failed, least.value_or(*failed));
  return least;
}

template <class T, int W>
std::size_t StagedRows<T, W>::bytes() const {
  std::size_t sum = 0;
  for (const auto& stage : stages_) sum += stage.bytes();
  for (const auto& carry : carry_) sum += carry.bytes();
  return sum;
}

#define DSS_INSTANTIATE(T, W) template class StagedRows<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
