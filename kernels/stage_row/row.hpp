#pragma once
/// Operands of the fused row kernel: plain data that the engine fills and the kernel reads.
#include "kernels/simd/simd.hpp"

#include <compare>
#include <cstddef>
#include <cstdint>

namespace dss {

#include "kernels/stage_row/row_action.h"

/// Lanes of a pack that have a link across each face. `link` is the face to the upper neighbour
/// row, `below` the face to the lower one.
struct PackMasks {
  simd::LaneMask link_x = 0, link_y = 0, link_z = 0, below_y = 0, below_z = 0;
  auto operator<=>(const PackMasks&) const = default;
};

/// Where the neighbours of a pack's elements lie in the packs of another row.
template <class T>
struct LaneMap {
  /// Packs of the other row. If the neighbours lie in more than two packs, they are scattered:
  /// `second` is negative, and `first` says where in RowTask::places theirs begin.
  int first = 0, second = 0;
  bool is_scattered() const { return second < 0; }
  /// Of each lane the neighbour's, counted over both packs; 0 if there is no neighbour.
  std::uint8_t lanes[simd::lanes<T>] = {};
};

/// Of a pack in a filled row.
template <class T>
struct PackMaps {
  LaneMap<T> upper_y, upper_z, lower_y, lower_z;
  const LaneMap<T>& upper(int axis) const { return axis == 1 ? upper_y : upper_z; }
  const LaneMap<T>& lower(int axis) const { return axis == 1 ? lower_y : lower_z; }
};

/// Constants of a body, in the form of the kernels.
template <class T>
struct BodyConstants {
#define NUMBER T
#include "kernels/stage_row/body_constants.h"
#undef NUMBER
};

/// A number of each lane.
template <class T>
struct LaneNumbers {
  alignas(sizeof(T) * std::size_t(simd::lanes<T>)) T value[simd::lanes<T>];
  operator simd::Pack<T>() const { return simd::load(value); }
};

/// Constants of a link of the material law.
template <class Number>
struct LinkConstants {
#define CONSTANT Number
#include "kernels/stage_row/link_constants.h"
#undef CONSTANT
};
/// Those of the links across one face of a pack's elements.
template <class T>
using LinkLanes = LinkConstants<LaneNumbers<T>>;

/// Constants of the elements of a pack, from sums of strains to P and Q
/// (kernels/stage_row/element_pressure.hpp): V lambda' / 4, and V b_o / 2 for o = x, y, z [N m].
template <class Number>
struct PressureConstants {
  Number s, x, y, z;
};
template <class T>
using PressureLanes = PressureConstants<LaneNumbers<T>>;

/// What lies in the lanes of a pack.
enum class LaneKind {
  neighbours, ///< elements that follow one another along x
  members,    ///< the same element of the members of an ensemble
  /// The elements of a row one after the other, without its holes. So neighbours in the rows beside
  /// it lie in other lanes, and maps say in which.
  filled,
};

/// Wrenches and clamps of a row, on the packs [first, first + packs). Most rows have none.
template <class T>
struct Applied {
  /// Components of force [N] and moment [N m] at signal value 1, pack by pack from the pattern's
  /// own first pack.
  struct Pattern {
    const T* values;
    int signal, first, packs;
  };
  int first = 0, packs = 0;
  const Pattern* patterns = nullptr;
  int pattern_count = 0;
  /// Lanes that may accelerate: from pack `first` on, one mask for each degree of freedom of a
  /// pack. Null: all lanes.
  const simd::LaneMask* free_lanes = nullptr;
};

/// Pressures of a row's elements. They are the last numbers of its packs.
template <class T>
struct RowPressure {
  const PressureLanes<T>* constants = nullptr;
  const int* index = nullptr; ///< of each pack, which of the constants its elements have
  /// Shares of loads, as patterns of one component: 2 t at signal value 1. Null for most rows.
  const Applied<T>* loads = nullptr;
};

/// One stage of one row, or the pressures at its input. Pointers start at the row's first pack.
/// Neighbour rows are already aligned with it.
template <class T>
struct RowTask {
  static constexpr int most_increments = 10;
  row_action action = plain_stage;
  bool is_last = false; ///< last stage of a step: its velocities are checked
  int packs = 0;
  int stride = 0;      ///< numbers from pack to pack in all rows except carries
  int low = 0;         ///< compensated: distance from a number to its low part or increment
  int fetch_lines = 0; ///< cache lines of `fetch` a pack
  int increments = 0;
  const PackMasks* masks = nullptr;
  const PackMaps<T>* maps = nullptr; ///< of each pack; null if neighbours lie in the same lanes
  const int* places = nullptr;       ///< of scattered neighbours, in lanes from their row's first
  const BodyConstants<T>* body = nullptr;
  const Applied<T>* applied = nullptr;      ///< null for most rows
  const RowPressure<T>* pressure = nullptr; ///< null if the elements have none
  /// Of each pack the places of its elements at rest, if the frame rotates; else null.
  const T* rest = nullptr;
  /// Of each pack 1 over the mass ratios of its elements (Problem::mass_ratio); null if all are 1.
  const T* inverse_ratios = nullptr;
  /// Frame acceleration x, y, z, then the loads' values, then the frame's angular velocity and its
  /// derivative if it rotates. Of an ensemble: each of all lanes.
  const T* signals = nullptr;
  /// Of an ensemble, in place of `body`: the constants of each lane.
  const BodyConstants<LaneNumbers<T>>* members = nullptr;
  /// Of the material law: constants of links, and for each pack which of them its links along x, y,
  /// z have. Null: all packs have the first three.
  const LinkLanes<T>* links = nullptr;
  const int* link_index = nullptr;
  const simd::LaneMask* live_lanes = nullptr; ///< of an ensemble: lanes whose results are checked
  /// A row of a later task, brought into L2 in parts along with the packs of this one; null: none.
  const char* fetch = nullptr;
  const T* in = nullptr;    ///< input of the stage
  const T* ahead = nullptr; ///< the pack behind the row; must be readable if the row ends there
  const T *upper_y = nullptr, *upper_z = nullptr;
  T *carry_y = nullptr, *carry_z = nullptr; ///< link forces and couples for the upper rows
  /// Of a piece of a cut row: the links to the next piece, and those that the piece before left.
  /// Null if there is none.
  T* carry_x = nullptr;
  const T* from_x = nullptr;
  /// What the lower rows left; may be the same buffers as carry_y and carry_z unless there are
  /// maps.
  const T *from_y = nullptr, *from_z = nullptr;
  // plain_stage: out = base + beta f(in).
  // With increments: out = base + alpha_0 [beta f(in) + (increment_0 - base) +
  // sum_{m > 0} alpha_m (increment_m - base)]. So beta and the later alpha are ratios to alpha_0
  // (rk_update.h).
  // In place: beta = h and in == base == out. predicted_step and kept_predicted: alpha_0 is
  // `smoothing` and alpha_1 is `ahead` of rk_update.h, the latter in steps.
  const T* base = nullptr;
  T* out = nullptr;
  T beta = 0;
  const T* betas = nullptr; ///< of an ensemble, in place of `beta`: of each lane
  /// Unused places repeat the first increment, with the ratio 0.
  const T* increment[most_increments] = {};
  T alpha[most_increments] = {};
};

} // namespace dss
