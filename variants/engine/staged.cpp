#include "variants/engine/staged.hpp"

namespace dss {

template <class T>
StagedRows<T>::StagedRows(PackedRows<T>& packed, const Problem& problem, const Method& method, double dt, int fields,
                          int threads)
    : packed_(packed), method_(method), fields_(fields),
      pack_size_(std::size_t(fields) * std::size_t(PackedRows<T>::W)), cuts_(cut_rows(packed, threads)),
      failed_rows_(cuts_.size() - 1, -1), updates_(stage_updates<T>(method, dt)), extra_links_(problem, packed) {
  const PackedRow<T>& last = packed.rows.back();
  const std::size_t packs = last.pack_offset + std::size_t(last.packs) + 1; // rows look one pack ahead
  const int copies = std::max(method.stages, 2);
  for (int m = 0; m < copies; ++m) stages_.emplace_back(packs * pack_size_);
  for (std::size_t t = 0; t + 1 < cuts_.size(); ++t) carry_.emplace_back(packed);
}

template <class T>
int StagedRows<T>::failed_row() const {
  for (const int row : failed_rows_)
    if (row >= 0) return row;
  return -1;
}

template <class T>
std::size_t StagedRows<T>::bytes() const {
  std::size_t sum = 0;
  for (const auto& stage : stages_) sum += stage.bytes();
  for (const auto& carry : carry_) sum += carry.bytes();
  return sum;
}

template class StagedRows<double>;
template class StagedRows<float>;

} // namespace dss
