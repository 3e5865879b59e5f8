#include "variants/engine/wavefront.hpp"

#include "variants/engine/packs.hpp"

#include <algorithm>
#include <stdexcept>

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
int steps_a_pass(const PackedRows<T, W>& packed, const Method& method,
                 const std::vector<int>& cuts) {
  if (!method.is_in_place() || packed.is_part()) return 1;
  const int rows = int(packed.rows.size());
  const auto recomputes_little = [&](int steps) {
    for (std::size_t b = 0; b + 1 < cuts.size(); ++b) {
      std::size_t more = 0;
      for (int halo = packed.reach; halo <= (steps - 1) * packed.reach && halo > 0;
           halo += packed.reach)
        more += packed.packs_of(std::max(0, cuts[b] - halo), cuts[b]) +
                packed.packs_of(cuts[b + 1], std::min(rows, cuts[b + 1] + halo));
      if (16 * more > std::size_t(steps) * packed.packs_of(cuts[b], cuts[b + 1])) return false;
    }
    return true;
  };
  int steps = packed.reach <= 1 ? 8 : 4;
  while (steps > 1 && !recomputes_little(steps)) --steps;
  return steps;
}

template <class T>
std::vector<StageUpdate<T>> stage_updates(const Method& method, const RowStorage& storage,
                                          int lanes, double dt) {
  if (method.has_error_stage) dt = 1;
  std::vector<StageUpdate<T>> updates;
  for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
    StageUpdate<T> update;
    double first = 0;
    for (std::size_t m = 1; m <= s; ++m) {
      const double alpha = method.alpha[s][m];
      if (alpha == 0) continue;
      update.increments.push_back({int(m) - 1, T(first == 0 ? alpha : alpha / first)});
      if (first == 0) first = alpha;
    }
    update.is_last = int(s) + 1 == method.stages;
    update.action = action_of(method, storage, update.increments.size(), update.is_last);
    // StepMaxima tells whether the result is finite.
    if (method.has_error_stage) update.is_last = false;
    update.low = storage.first_low() * lanes;
    if (storage.is_predicted())
      update.smoothing = T(method.smoothing), update.steps_ahead = T((1 - method.smoothing) / 2);
    update.beta = T(dt * method.beta[s] / (first == 0 ? 1 : first));
    if (update.increments.size() > RowTask<T>::most_increments)
      throw std::logic_error("method with more increments than a row task holds");
    updates.push_back(std::move(update));
  }
  return updates;
}

int last_reader(const Method& method, int s) {
  for (int reader = method.stages - 1; reader > s + 1; --reader)
    if (method.alpha[std::size_t(reader)][std::size_t(s) + 1] != 0) return reader;
  return s + 1;
}

template <class T, int W>
Block<T, W>::Block(const PackedRows<T, W>& packed, const Method& method, int first, int last,
                   int fields, int halo, int steps)
    : begin(first), end(last), stored_begin(steps == 1 ? begin : std::max(0, begin - halo)),
      stored_end(steps == 1 ? end : std::min(int(packed.rows.size()), end + halo)),
      packed_(&packed), pack_size_(std::size_t(fields) * std::size_t(W)),
      row_size_(std::size_t(packed.max_packs + 1) * pack_size_), halo_(halo) {
  // One pack more: rows look one pack ahead.
  state_ = Buffer<T>((packed.packs_of(stored_begin, stored_end) + 1) * pack_size_, packed.memory);
  make_published();
  for (int s = 0; s < steps * method.stages; ++s) carry.emplace_back(packed);
  for (int stage = 0; stage + 1 < method.stages; ++stage) {
    // Stage s writes Y_{s + 1}, and its last reader runs (reader - s) reaches behind. Priming, the
    // computation of the links before a block's first row, reads two reaches back.
    const int reaches = std::max(last_reader(method, stage) - stage, begin > 0 ? 2 : 1);
    const int rows = std::min(reaches * packed.reach + 1, int(packed.rows.size()));
    rings_.emplace_back(std::size_t(rows) * row_size_ + pack_size_, packed.memory);
    ring_rows_.emplace_back();
    for (int r = 0; r < int(packed.rows.size()); ++r)
      ring_rows_.back().push_back(rings_.back().data() + std::size_t(r % rows) * row_size_);
  }
}

template <class T, int W>
Block<T, W>::Block(const PackedRows<T, W>& packed, int first, int last, int fields, int halo)
    : begin(first), end(last), stored_begin(first), stored_end(first), packed_(&packed),
      pack_size_(std::size_t(fields) * std::size_t(W)), row_size_(0), halo_(halo) {
  make_published();
}

template <class T, int W>
void Block<T, W>::make_published() {
  std::size_t packs = 0;
  for (int r = begin; r < end; ++r) {
    published_offset_.push_back(packs * pack_size_);
    if (is_published(r)) packs += std::size_t(packed_->rows[std::size_t(r)].packs);
  }
  for (auto& copy : published_)
    copy = Buffer<T>(packs == 0 ? 0 : (packs + 1) * pack_size_, packed_->memory);
}

template <class T, int W>
void Block<T, W>::publish(int r, int parity) {
  std::copy_n(row(r), row_length(r), published(r, parity));
}

template <class T, int W>
std::size_t Block<T, W>::bytes() const {
  std::size_t sum = state_.bytes() + published_[0].bytes() + published_[1].bytes();
  for (const auto& ring : rings_) sum += ring.bytes();
  for (const auto& rings : carry) sum += rings.bytes();
  for (const auto& rows : ring_rows_) sum += rows.size() * sizeof(T*);
  return sum;
}

template <class T, int W>
WavefrontStep<T, W>::WavefrontStep(const PackedRows<T, W>& packed, const Method& method, double dt,
                                   const RowStorage& storage, std::size_t signal_count,
                                   std::vector<Block<T, W>>& blocks, std::size_t index, int steps)
    : packed_(packed), fields_(storage.stored()), stages_(method.stages), steps_(steps),
      block_(blocks[index]), signals_(signal_count, steps * method.stages) {
  find_published_rows(blocks);
  const std::vector<StageUpdate<T>> updates = stage_updates<T>(method, storage, W, dt);
  sweeps_[0] = make_sweeps(updates, 0);
  if (blocks.size() > 1 && steps == 1) sweeps_[1] = make_sweeps(updates, 1);
}

template <class T, int W>
void WavefrontStep<T, W>::find_published_rows(std::vector<Block<T, W>>& blocks) {
  const int halo = steps_ * stages_ * packed_.reach;
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
void WavefrontStep<T, W>::fetch_halo(int parity) {
  for (int r = block_.stored_begin; r < block_.stored_end; ++r)
    if (!block_.owns(r)) std::copy_n(published_row(r, parity), block_.row_length(r), block_.row(r));
}

template <class T, int W>
auto WavefrontStep<T, W>::make_sweeps(const std::vector<StageUpdate<T>>& updates, int parity)
    -> std::vector<Sweep> {
  std::vector<Sweep> sweeps;
  const int count = steps_ * stages_;
  for (int n = 0; n < count; ++n) {
    const int s = n % stages_, halo = (count - 1 - n) * packed_.reach;
    const bool is_last = s + 1 == stages_;
    Sweep sweep{std::max(0, block_.begin - halo),
                std::min(int(packed_.rows.size()), block_.end + halo),
                {}};
    sweep.rows.reserve(std::size_t(sweep.end - sweep.begin));
    for (int r = sweep.begin; r < sweep.end; ++r) {
      RowTask<T> task;
      set_row(task, packed_, r, fields_, block_.carry[std::size_t(n)],
              [&](int row) { return input_row(s, row, parity); });
      task.signals = signals_.stage(n);
      T* const base = stepped_row(r, parity);
      updates[std::size_t(s)].set(task, base, is_last ? base : block_.ring_row(s, r),
                                  [&](int m) { return block_.ring_row(m, r); });
      sweep.rows.push_back({packed_.is_computed(r, stages_ - 1 - s), task});
    }
    sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

template <class T, int W>
std::size_t WavefrontStep<T, W>::bytes() const {
  std::size_t sum = (published_rows_[0].size() + published_rows_[1].size()) * sizeof(T*);
  for (const auto& sweeps : sweeps_)
    for (const Sweep& sweep : sweeps) sum += sweep.rows.size() * sizeof(RowStage);
  return sum;
}

template <class T, int W>
void WavefrontStep<T, W>::operator()(const double* signals, int steps, int parity) {
  const std::vector<Sweep>& sweeps = sweeps_[sweeps_[1].empty() ? 0 : std::size_t(parity)];
  const int last = steps * stages_ - 1;
  // Sweeps that run. After a failure only those of earlier steps, since these may fail too.
  int count = last + 1;
  signals_.set(signals, count);
  fetch_halo(parity);
  bool is_watched = watched_row_ >= 0;
  const int lag = packed_.reach, end = sweeps[std::size_t(last)].end + last * lag;
  for (int t = sweeps[0].begin; t < end; ++t)
    for (int n = 0; n < count; ++n) {
      const Sweep& sweep = sweeps[std::size_t(n)];
      const int r = t - n * lag, s = n % stages_;
      if (r < sweep.begin || r >= sweep.end) continue;
      if (r == sweep.begin && r > 0)
        prime_links(packed_, r, fields_, block_.carry[std::size_t(n)],
                    [&](int row) { return input_row(s, row, parity); });
      const RowStage& row = sweep.rows[std::size_t(r - sweep.begin)];
      if (!row.is_whole) {
        prime_uppers(packed_, r, row.task);
      } else if (!packed_.rows[std::size_t(r)].kernels->stage(row.task) && block_.owns(r) &&
                 packed_.first_failed(r, block_.row(r), fields_)) {
        block_.failed_row = r, block_.failed_step = n / stages_, count = n;
      }
      if (n != last || !block_.owns(r)) continue;
      if (block_.is_published(r)) block_.publish(r, parity ^ 1);
      if (r == watched_row_) is_watched = false, watched_row_done_();
    }
  // A failure ended the pass before this row, but others wait for it.
  if (is_watched) watched_row_done_();
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template std::vector<int> cut_rows(const PackedRows<T, W>&, int);                                \
  template int steps_a_pass(const PackedRows<T, W>&, const Method&, const std::vector<int>&);      \
  template class Block<T, W>;                                                                      \
  template class WavefrontStep<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE
template std::vector<StageUpdate<double>> stage_updates(const Method&, const RowStorage&, int,
                                                        double);
template std::vector<StageUpdate<float>> stage_updates(const Method&, const RowStorage&, int,
                                                       double);

} // namespace dss
