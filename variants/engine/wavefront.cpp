#include "variants/engine/wavefront.hpp"

#include <algorithm>
#include <stdexcept>

namespace dss {

template <class T>
std::vector<int> cut_rows(const PackedRows<T>& packed, int parts) {
  const int rows = int(packed.rows.size());
  parts = std::clamp(parts, 1, rows);
  const std::size_t packs = packed.rows.back().pack_offset + std::size_t(packed.rows.back().packs);
  std::vector<int> cuts{0};
  for (int p = 1; p < parts; ++p) {
    const std::size_t target = packs * std::size_t(p) / std::size_t(parts);
    int row = cuts.back() + 1; // every block has a row
    while (row < rows - (parts - p) && packed.rows[std::size_t(row)].pack_offset < target) ++row;
    cuts.push_back(row);
  }
  cuts.push_back(rows);
  return cuts;
}

template <class T>
std::vector<StageUpdate<T>> stage_updates(const Method& method, double dt) {
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
    if (update.increments.empty() && int(s) + 1 == method.stages) update.increments.push_back({-1, T(1)});
    update.beta = T(dt * method.beta[s] / (first == 0 ? 1 : first));
    if (update.increments.size() > std::size(RowTask<T>{}.alpha))
      throw std::logic_error("method with more increments than a row task holds");
    updates.push_back(std::move(update));
  }
  return updates;
}

template <class T>
Block<T>::Block(const PackedRows<T>& packed, int first, int last, int fields, int halo, bool has_rings, int stages)
    : begin(first), end(last), packed_(&packed), pack_size_(std::size_t(fields) * std::size_t(PackedRows<T>::W)),
      row_size_(std::size_t(packed.max_packs + 1) * pack_size_), halo_(halo),
      published_index_(std::size_t(last - first), -1) {
  const PackedRow<T>& last_row = packed.rows[std::size_t(end - 1)];
  const std::size_t packs =
      last_row.pack_offset + std::size_t(last_row.packs) - packed.rows[std::size_t(begin)].pack_offset;
  state_ = Buffer<T>((packs + 1) * pack_size_); // one pack more: rows look one pack ahead
  int count = 0;
  for (int r = begin; r < end; ++r)
    if (is_published(r)) published_index_[std::size_t(r - begin)] = count++;
  for (auto& copy : published_) copy = Buffer<T>(std::size_t(count) * row_size_);
  for (int s = 0; s < stages; ++s) carry.emplace_back(packed);
  if (!has_rings) return;
  for (int s = 0; s + 1 < stages; ++s) {
    // Y_{s + 1} is written by stage s and last read by the final stage, (stages - 1 - s) reaches behind; priming reads
    // two reaches back.
    const int reaches = begin > 0 ? std::max(stages - 1 - s, 2) : stages - 1 - s;
    const int rows = std::min(reaches * packed.reach + 1, int(packed.rows.size()));
    rings_.emplace_back(std::size_t(rows) * row_size_ + pack_size_);
    ring_rows_.emplace_back();
    for (int r = 0; r < int(packed.rows.size()); ++r)
      ring_rows_.back().push_back(rings_.back().data() + std::size_t(r % rows) * row_size_);
  }
}

template <class T>
void Block<T>::publish(int r, int parity) {
  const std::size_t packs = std::size_t(packed_->rows[std::size_t(r)].packs);
  std::copy_n(row(r), packs * pack_size_, published(r, parity));
}

template <class T>
std::size_t Block<T>::bytes() const {
  std::size_t sum = state_.bytes() + published_[0].bytes() + published_[1].bytes();
  for (const auto& ring : rings_) sum += ring.bytes();
  for (const auto& rings : carry) sum += rings.bytes();
  for (const auto& rows : ring_rows_) sum += rows.size() * sizeof(T*);
  return sum;
}

template <class T>
WavefrontStep<T>::WavefrontStep(const PackedRows<T>& packed, const Method& method, double dt, int fields,
                                std::vector<Block<T>>& blocks)
    : packed_(packed), method_(method), fields_(fields), updates_(stage_updates<T>(method, dt)), blocks_(blocks) {
  const int halo = method.stages * packed.reach;
  for (Block<T>& block : blocks) {
    auto& rows = state_rows_.emplace_back();
    for (int parity : {0, 1}) {
      rows[std::size_t(parity)].assign(packed.rows.size(), nullptr);
      for (Block<T>& other : blocks)
        for (int r = std::max(other.begin, block.begin - halo); r < std::min(other.end, block.end + halo); ++r)
          rows[std::size_t(parity)][std::size_t(r)] = &other == &block ? block.row(r) : other.published(r, parity);
    }
  }
}

template <class T>
void WavefrontStep<T>::stage_row(Block<T>& block, int stage, int r, const StepSignals<T>& signals, int parity) const {
  const KernelSet<T>& kernels = *packed_.rows[std::size_t(r)].kernels;
  const bool is_last = stage + 1 == method_.stages;
  const auto input = [&](int row) {
    return stage == 0 ? state_row(block, row, parity) : block.ring_row(stage - 1, row);
  };
  RowTask<T> task;
  set_row(task, packed_, r, fields_, block.carry[std::size_t(stage)], input);
  task.signals = signals.stage(stage);
  T* const base = state_row(block, r, parity);
  updates_[std::size_t(stage)].set(task, base, is_last ? base : block.ring_row(stage, r),
                                   [&](int m) { return block.ring_row(m, r); });
  const bool is_finite = method_.family == Method::Family::leapfrog ? kernels.leapfrog(task) : kernels.stage(task);
  if (!is_finite && is_last && block.failed_row < 0) block.failed_row = r;
  if (is_last && block.is_published(r)) block.publish(r, parity ^ 1);
}

template <class T>
void WavefrontStep<T>::operator()(Block<T>& block, const StepSignals<T>& signals, int parity) const {
  const int stages = method_.stages, reach = packed_.reach, rows = int(packed_.rows.size());
  // Stage s covers the block and (stages - 1 - s) reaches on either side: what the later stages of the block read.
  const auto first = [&](int s) { return std::max(0, block.begin - (stages - 1 - s) * reach); };
  const auto last = [&](int s) { return std::min(rows, block.end + (stages - 1 - s) * reach); };
  for (int t = first(0); t < last(stages - 1) + (stages - 1) * reach; ++t)
    for (int s = 0; s < stages; ++s) {
      const int r = t - s * reach;
      if (r < first(s) || r >= last(s)) continue;
      if (r == first(s) && r > 0)
        prime_links(packed_, r, fields_, block.carry[std::size_t(s)],
                    [&](int row) { return s == 0 ? state_row(block, row, parity) : block.ring_row(s - 1, row); });
      stage_row(block, s, r, signals, parity);
    }
}

#define DSS_INSTANTIATE(T)                                                                                             \
  template std::vector<int> cut_rows(const PackedRows<T>&, int);                                                       \
  template class Block<T>;                                                                                             \
  template class WavefrontStep<T>;                                                                                     \
  template std::vector<StageUpdate<T>> stage_updates(const Method&, double);
DSS_INSTANTIATE(double)
DSS_INSTANTIATE(float)
#undef DSS_INSTANTIATE

} // namespace dss
