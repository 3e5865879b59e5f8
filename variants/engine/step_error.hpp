#pragma once
/// Reads the result of a tried step from rows of packs: maxima of its estimated error and of its
/// state. Makes that state the next one.
#include "kernels/physics.hpp"
#include "solver/numerics/step_control.hpp"
#include "variants/engine/row_storage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace dss {

/// Lanes of own elements in every pack of all rows.
/// @param part  null for a whole problem
template <class T, int W>
std::vector<simd::LaneMask> own_lanes(const PackedRows<T, W>& packed, const Part* part) {
  std::vector<simd::LaneMask> lanes(packed.readable_packs(), 0);
  for (std::size_t r = 0; r < packed.rows.size(); ++r) {
    const PackedRow<T>& row = packed.rows[r];
    packed.each_element(int(r), [&](std::size_t element, int x) {
      if (part == nullptr || part->layer[element] == 0)
        lanes[row.pack_offset + std::size_t(x / W - row.first_pack)] |=
            simd::LaneMask(1u << (x % W));
    });
  }
  return lanes;
}

/// Maxima over packs. They are kept for each lane and joined in maxima().
template <class T, int W>
class LaneMaxima {
public:
  /// Adds one pack.
  /// @param error, state  the first of `fields` fields of a pack
  /// @param own           lanes of own elements; others do not count
  void add(const T* error, const T* state, simd::LaneMask own, std::span<const Field> fields) {
    std::array<bool, W> counts;
    for (int l = 0; l < W; ++l) counts[std::size_t(l)] = own >> l & 1;
    for (std::size_t f = 0; f < fields.size(); ++f, error += W, state += W) {
      const std::size_t kind = StepMaxima::kind(fields[f]);
      for (std::size_t l = 0; l < std::size_t(W); ++l) {
        const T e = counts[l] ? std::abs(error[l]) : T(0),
                y = counts[l] ? std::abs(state[l]) : T(0);
        error_[kind][l] = error_[kind][l] < e ? e : error_[kind][l];
        state_[kind][l] = state_[kind][l] < y ? y : state_[kind][l];
        check_[l] += T(0) * e + T(0) * y; // stays 0 until a number is infinite or NaN
      }
    }
  }
  StepMaxima maxima() const {
    StepMaxima all;
    for (std::size_t l = 0; l < std::size_t(W); ++l) {
      for (std::size_t k = 0; k < StepMaxima::kinds; ++k) {
        all.error[k] = std::max(all.error[k], double(error_[k][l]));
        all.state[k] = std::max(all.state[k], double(state_[k][l]));
      }
      all.is_finite &= check_[l] == T(0);
    }
    return all;
  }

private:
  using Lanes = std::array<T, std::size_t(W)>;
  std::array<Lanes, StepMaxima::kinds> error_{}, state_{};
  Lanes check_{};
};

/// Makes `next`, the output of the last stage but one, the state of a row. In compensated precision
/// increments follow the fields in `next`; the low parts of the sum are computed as in kept_step.
template <class T>
void accept_row(const RowStorage& storage, int packs, int lanes, const T* next, T* state) {
  const std::size_t pack_size = std::size_t(storage.stored() * lanes);
  if (!storage.is_compensated()) {
    std::copy_n(next, std::size_t(packs) * pack_size, state);
    return;
  }
  const std::size_t low = std::size_t(storage.first_low() * lanes),
                    fields = std::size_t(storage.fields * lanes);
  for (int p = 0; p < packs; ++p, next += pack_size, state += pack_size)
    for (std::size_t n = 0; n < fields; ++n) {
      const T y = state[n], s = state[low + n] + next[low + n], sum = next[n];
      state[low + n] = Physics<Model::spatial, T>::lost_of_sum(y, s, sum);
      state[n] = sum;
    }
}

} // namespace dss
