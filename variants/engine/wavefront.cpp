#include "variants/engine/wavefront.hpp"

#include "solver/error.hpp"
#include "variants/api/cache_sizes.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace dss {

template <class T, int W>
std::vector<int> cut_rows(const PackedRows<T, W>& packed, int parts) {
  const int begin = packed.own_begin, end = packed.own_end;
  parts = std::clamp(parts, 1, end - begin);
  const std::size_t first = packed.rows[std::size_t(begin)].pack_offset,
                    packs = packed.packs_of(begin, end);
  std::vector<int> cuts{begin};
  for (int p = 1; p < parts; ++p) {
    const std::size_t target = first + packs * std::size_t(p) / std::size_t(parts);
    int row = cuts.back() + 1; // every block has a row
    while (row < end - (parts - p) && packed.rows[std::size_t(row)].pack_offset < target) ++row;
    cuts.push_back(row);
  }
  cuts.push_back(end);
  return cuts;
}

template <class T, int W>
double halo_work(const PackedRows<T, W>& packed, const std::vector<int>& cuts, int sweeps) {
  const int rows = int(packed.rows.size());
  double most = 0;
  for (std::size_t b = 0; b + 1 < cuts.size(); ++b) {
    std::size_t more = 0;
    for (int n = 1; n < sweeps; ++n) {
      const int halo = n * packed.stage_halo;
      more += packed.packs_of(std::max(0, cuts[b] - halo), cuts[b]) +
              packed.packs_of(cuts[b + 1], std::min(rows, cuts[b + 1] + halo));
    }
    most = std::max(most, double(more) / (sweeps * double(packed.packs_of(cuts[b], cuts[b + 1]))));
  }
  return most;
}

template <class T, int W>
int steps_a_pass(const PackedRows<T, W>& packed, const Method& method,
                 const std::vector<int>& cuts) {
  if (!method.is_in_place() || packed.is_part()) return 1;
  int steps = packed.reach <= 1 ? 8 : 4;
  while (steps > 1 && halo_work(packed, cuts, steps) > 1. / 16) --steps;
  return steps;
}

/// The last stage that reads the output of stage s.
static int last_reader(const Method& method, int s) {
  for (int reader = method.stages - 1; reader > s + 1; --reader)
    if (method.alpha[std::size_t(reader)][std::size_t(s) + 1] != 0) return reader;
  return s + 1;
}

/// What the rows between the first and the last sweep of a tile should take at most [B]. Two kinds
/// of processors were measured (README.md). Beside an L2 of 1 MB (Zen 4) the L3 is fast, and tiles
/// may take about L2 and a core's share of L3: narrower ones pay more for their seams than they
/// gain. Beside an L2 of 2 MB (server cores of Intel since Sapphire Rapids) the L3 is slow, and
/// tiles should leave a third of L2 free.
static std::size_t tile_bytes() {
  constexpr std::size_t large_l2 = 2u << 20;
  return l2_bytes() >= large_l2 ? l2_bytes() * 2 / 3 : 5 * l2_bytes();
}

template <class T, int W>
int choose_tile(const PackedRows<T, W>& packed, const Method& method, const RowStorage& storage,
                int steps, const std::vector<int>& cuts, bool is_in_row_order,
                std::span<const LinkedRows> extra, int asked) {
  // Planes of rows between the first and the last touch of a row: of the state and of the links one
  // for each sweep, of the output of a stage those up to its last reader.
  const int sweeps = steps * method.stages;
  double planes = sweeps * (1 + double(packed.carry_size) / (storage.stored() * W));
  for (int stage = 0; stage + 1 < method.stages; ++stage)
    planes += last_reader(method, stage) - stage;
  const double across_bytes = planes * double(packed.max_packs) * storage.stored() * W * sizeof(T);
  int across = 0;
  for (std::size_t b = 0; b + 1 < cuts.size(); ++b)
    across = std::max(
        across, most_rows_across(packed.lattice, {cuts[b], cuts[b + 1]}, is_in_row_order, extra));
  if (asked >= across || across <= 1) return no_tiles;
  if (const int most = int(double(l3_bytes()) / across_bytes); asked > std::max(most, 1))
    throw InputError(fmt::format(
        "--tile {}: between its sweeps, {:.0f} MB of rows would leave the caches; give at most {}",
        asked, 1e-6 * asked * across_bytes, std::max(most, 1)));
  if (asked > 0) return asked;
  const double fit = double(tile_bytes()) / across_bytes;
  if (across <= fit) return no_tiles;
  const int tiles = int(std::ceil(across / std::max(fit, 1.0)));
  return (across + tiles - 1) / tiles;
}

template <class T, int W>
WavefrontStep<T, W>::WavefrontStep(PackedRows<T, W>& packed, const Method& method,
                                   std::span<const double> dt, const RowStorage& storage,
                                   std::size_t signal_count, std::vector<Block<T, W>>& blocks,
                                   std::size_t index, PassShape shape,
                                   const ExtraLinks<T, W>& extra_links)
    : packed_(packed), fields_(storage.stored()), stages_(method.stages), steps_(shape.steps),
      row_size_(std::size_t(packed.max_packs) * std::size_t(fields_ * W)),
      links_size_(std::size_t(packed.packs_across) * std::size_t(packed.carry_size)),
      block_(blocks[index]),
      signals_(signal_count, steps_ * method.stages, packed.members().size()),
      updates_(stage_updates<T>(method, storage, W, dt)), extra_links_(extra_links),
      extra_wrenches_(packed, extra_links.rows()) {
  find_published_rows(blocks);
  const std::vector<PassTask> tasks = order(shape.form);
  make_places(tasks);
  tasks_[0] = make_tasks(tasks, 0);
  if (blocks.size() > 1 && steps_ == 1) tasks_[1] = make_tasks(tasks, 1);
  places_.reset();
}

template <class T, int W>
void WavefrontStep<T, W>::find_published_rows(std::vector<Block<T, W>>& blocks) {
  const int halo = steps_ * stages_ * packed_.stage_halo;
  for (int parity : {0, 1}) {
    std::vector<T*>& rows = published_rows_[std::size_t(parity)];
    rows.assign(packed_.rows.size(), nullptr);
    for (Block<T, W>& other : blocks)
      for (int r = std::max(other.begin, block_.begin - halo);
           r < std::min(other.end, block_.end + halo); ++r)
        if (&other != &block_) rows[std::size_t(r)] = other.published(r, parity);
  }
}

template <class T, int W>
void WavefrontStep<T, W>::copy_halo(int parity) {
  for (int r = block_.stored_begin; r < block_.stored_end; ++r)
    if (!block_.owns(r)) std::copy_n(published_row(r, parity), block_.row_length(r), block_.row(r));
}

template <class T, int W>
std::vector<PassTask> WavefrontStep<T, W>::order(SweepForm form) const {
  const int count = steps_ * stages_, rows = int(packed_.rows.size());
  std::vector<SweepRows> sweeps;
  for (int n = 0; n < count; ++n) {
    const int halo = (count - 1 - n) * packed_.stage_halo;
    sweeps.push_back({std::max(0, block_.begin - halo), std::min(rows, block_.end + halo)});
  }
  std::vector<PassTask> tasks = order_pass(packed_.lattice, sweeps, form, extra_links_.rows());
  for (PassTask& task : tasks)
    if (task.work == RowWork::stage &&
        !packed_.is_computed(task.row, stages_ - 1 - task.sweep % stages_))
      task.work = RowWork::upper_links;
  return tasks;
}

template <class T, int W>
void WavefrontStep<T, W>::make_places(const std::vector<PassTask>& order) {
  std::vector<std::vector<int>> increments;
  for (const StageUpdate<T>& update : updates_) {
    increments.emplace_back();
    for (const auto& [stage, alpha] : update.increments) increments.back().push_back(stage);
  }
  places_.emplace(packed_.lattice, order, steps_ * stages_, stages_, increments,
                  extra_links_.rows());
  // One pack more: rows look one pack ahead.
  stage_rows_ =
      Buffer<T>(std::size_t(places_->stage_row_count()) * row_size_ + std::size_t(fields_ * W),
                packed_.memory);
  for (const int axis : {1, 2})
    links_[std::size_t(axis) - 1] =
        Buffer<T>(std::size_t(places_->links_count(axis)) * links_size_, packed_.memory);
}

template <class T, int W>
auto WavefrontStep<T, W>::make_tasks(const std::vector<PassTask>& order, int parity)
    -> std::vector<RowStage> {
  std::vector<RowStage> tasks;
  tasks.reserve(order.size());
  for (const PassTask& what : order) {
    if (what.is_extra()) {
      tasks.push_back(extra_task(what, parity));
      continue;
    }
    const int r = what.row, s = what.sweep % stages_;
    const bool is_last = s + 1 == stages_;
    RowStage stage{what.work,
                   what.work == RowWork::stage && is_last && block_.owns(r) &&
                       block_.is_published(r),
                   what.sweep,
                   r,
                   packed_.rows[std::size_t(r)].kernels,
                   {}};
    set_row(stage.task, packed_, r, fields_, SweepLinks{*this, what.sweep},
            [&](int row) { return input_row(s, row, parity); });
    stage.task.signals = signals_.stage(what.sweep);
    if (const Applied<T>* applied = extra_wrenches_.applied(r)) stage.task.applied = applied;
    if (what.work == RowWork::stage) {
      T* const base = stepped_row(r, parity);
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
  RowStage stage{what.work, false, what.sweep, what.row, nullptr, {}};
  if (what.work == RowWork::extra_sum) {
    stage.row = extra_links_.index_of(what.row);
    stage.task.out = extra_wrenches_.wrench(what.row);
    return stage;
  }
  const LinkedRows& rows = extra_links_.rows()[std::size_t(what.row)];
  stage.task.in = input_row(what.sweep % stages_, rows.i, parity);
  stage.task.base = input_row(what.sweep % stages_, rows.j, parity);
  return stage;
}

template <class T, int W>
void WavefrontStep<T, W>::watch(int row, std::function<void()> done) {
  const std::vector<RowStage>& all = tasks_[0];
  const bool is_known = std::exchange(watched_row_, row) == row;
  for (std::size_t n = 0; n < all.size() && !is_known; ++n)
    if (all[n].work == RowWork::stage && all[n].sweep + 1 == steps_ * stages_ && all[n].row <= row)
      watched_task_ = std::ptrdiff_t(n);
  watched_rows_done_ = std::move(done);
}

template <class T, int W>
std::size_t WavefrontStep<T, W>::bytes() const {
  return stage_rows_.bytes() + links_[0].bytes() + links_[1].bytes() + extra_links_.bytes() +
         extra_wrenches_.bytes() +
         (published_rows_[0].size() + published_rows_[1].size()) * sizeof(T*) +
         (tasks_[0].size() + tasks_[1].size()) * sizeof(RowStage);
}

template <class T, int W>
void WavefrontStep<T, W>::operator()(const double* signals, int steps, int parity) {
  // Sweeps that run. After a failure those up to the end of its step: earlier steps may fail too,
  // and lower rows of the same step.
  int count = steps * stages_;
  signals_.set(signals, count);
  copy_halo(parity);
  const std::vector<RowStage>& all = tasks(parity);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const RowStage& stage = all[n];
    if (n + 1 < all.size()) fetch(all[n + 1]);
    if (stage.sweep < count && !compute(stage) && block_.owns(stage.row) && note_failures(stage) &&
        !packed_.is_ensemble())
      count = stage.sweep + 1;
    if (stage.is_published && stage.sweep + 1 == steps * stages_)
      block_.publish(stage.row, parity ^ 1);
    if (std::ptrdiff_t(n) == watched_task_) watched_rows_done_();
  }
}

template <class T, int W>
bool WavefrontStep<T, W>::note_failures(const RowStage& stage) {
  bool has_failed = false;
  for (std::size_t m = 0; m < block_.failures.size(); ++m) {
    if (!packed_.is_live(int(m))) continue;
    const auto element = packed_.first_failed(stage.row, block_.row(stage.row), fields_, int(m));
    if (!element) continue;
    block_.failures[m].meet(stage.sweep / stages_, *element);
    has_failed = true;
  }
  return has_failed;
}

/// Tasks are read once a pass, so those of a large body are out of the cache by then.
template <class T, int W>
void WavefrontStep<T, W>::fetch(const RowStage& next) {
  for (std::size_t byte = 0; byte < sizeof(RowStage); byte += Memory::line)
    simd::fetch(reinterpret_cast<const char*>(&next) + byte);
}

template <class T, int W>
bool WavefrontStep<T, W>::compute(const RowStage& stage) {
  const RowTask<T>& task = stage.task;
  switch (stage.work) {
  case RowWork::stage:
    return stage.kernels->stage(task);
  case RowWork::upper_links:
    prime_uppers(*stage.kernels, task);
    break;
  case RowWork::upper_link_y:
    stage.kernels->prime(task, 1);
    break;
  case RowWork::upper_link_z:
    stage.kernels->prime(task, 2);
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

#define DSS_INSTANTIATE(T, W)                                                                      \
  template std::vector<int> cut_rows(const PackedRows<T, W>&, int);                                \
  template double halo_work(const PackedRows<T, W>&, const std::vector<int>&, int);                \
  template int steps_a_pass(const PackedRows<T, W>&, const Method&, const std::vector<int>&);      \
  template int choose_tile(const PackedRows<T, W>&, const Method&, const RowStorage&, int,         \
                           const std::vector<int>&, bool, std::span<const LinkedRows>, int);       \
  template class WavefrontStep<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
