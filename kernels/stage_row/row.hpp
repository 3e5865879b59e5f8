#pragma once
/// Operands of the fused row kernel. Plain data: the engine fills it, the kernel reads it.
#include "kernels/simd/simd.hpp"

namespace dss {

#include "kernels/stage_row/row_action.h"

/// Which lanes of a pack have a link across each face; `below` looks to the lower neighbour row, `link` to the upper
/// one.
struct PackMasks {
  simd::LaneMask link_x = 0, link_y = 0, link_z = 0, below_y = 0, below_z = 0;
};

/// Constants of a body as the laws need them, in the form of the kernels.
template <class T>
struct BodyConstants {
#define NUMBER T
#include "kernels/stage_row/body_constants.h"
#undef NUMBER
};

/// Wrenches and clamps of a row that has any, on the packs [first, first + packs).
template <class T>
struct Applied {
  /// Pack by pack from its own first pack, the force's and the moment's components [N], [N m] at signal value 1.
  struct Pattern {
    const T* values;
    int signal, first, packs;
  };
  int first = 0, packs = 0;
  const Pattern* patterns = nullptr;
  int pattern_count = 0;
  const simd::LaneMask* free_lanes =
      nullptr; ///< pack by pack from `first`, one mask a degree of freedom: lanes that may accelerate; or null
};

/// One stage of one row. Pointers start at the row's first pack; neighbours are already aligned with it.
template <class T>
struct RowTask {
  static constexpr int most_increments = 6;
  row_action action = plain_stage;
  bool is_last = false; ///< of a step: its velocities are looked at
  int packs = 0;
  int stride = 0; ///< numbers from pack to pack of all rows but carries
  int low = 0;    ///< compensated: from a number to its low part, or to its increment
  const PackMasks* masks = nullptr;
  const BodyConstants<T>* body = nullptr;
  const Applied<T>* applied = nullptr; ///< null for most rows
  const T* signals = nullptr;          ///< frame acceleration x, y, z, then the loads' values
  const T* in = nullptr;               ///< the stage's input; one readable pack follows the row
  const T *upper_y = nullptr, *upper_z = nullptr;
  T *carry_y = nullptr, *carry_z = nullptr;     ///< link forces and couples for the upper rows
  const T *from_y = nullptr, *from_z = nullptr; ///< those that the lower rows left; may be the same places
  // plain_stage: out = base + beta f(in). With increments: out = base + alpha_0 [beta f(in) + (increment_0 - base) + sum_{m > 0}
  // alpha_m (increment_m - base)], so beta and the later alpha are ratios to alpha_0 (rk_update.h). In place: beta = h,
  // in == base == out, and of predicted_step and kept_predicted alpha_0, alpha_1: what a prediction keeps of its correction, and how far it goes ahead, in steps.
  const T* base = nullptr;
  T* out = nullptr;
  T beta = 0;
  int increments = 0;
  const T* increment[most_increments] = {}; ///< behind the last of a combined stage the first again, with the ratio 0
  T alpha[most_increments] = {};
};

} // namespace dss
