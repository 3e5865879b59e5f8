#pragma once
/// The fused row kernel alone, for microbenchmarks and their checks: rows in the interior of a
/// plate that read and write plain arrays. Numbers are of order one. Rows of the result are never
/// read as input, so every call computes the same.
#include "kernels/stage_row/row.hpp"
#include "kernels/terms.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace dss {

/// Rows of `row_elements` elements (a multiple of the lanes), one above the other. The row above
/// the last is the first. Arrays hold packs, as in a step.
/// `in`: all rows of the stage's input, all rows of the base, for the last stage also of two
/// increments, then one pack that is read but not used.
/// `out`: all rows of the result, then `most_carry` numbers an element of one row, zero before the
/// first call.
/// The last stage has the weights of RK4.
struct RowCase {
  bool is_last, is_material;
  int fields, lanes;
  static constexpr int most_carry = 6;
  static constexpr int inputs(bool is_last) {
    return is_last ? 4 : 2;
  } ///< number of arrays of rows
};

/// The terms of these rows: those of the paper's plate, or of a damped body of the material law.
constexpr Terms row_case_terms(bool is_material) {
  return {.is_material = is_material, .is_damped = true};
}

/// Constants of a body that keep the numbers of order one.
template <class T>
BodyConstants<T> row_case_body() {
  BodyConstants<T> body{};
  for (T& edge : body.edge) edge = T(0.5);
  for (T& half : body.half_edge) half = T(0.25);
  for (T& inverse : body.inverse_edge) inverse = T(2);
  body.edge_ratio = body.inverse_unit = body.mass = body.inverse_mass = T(1);
  body.tau = body.dt = T(0.125);
  for (int axis = 0; axis < 3; ++axis) body.inertia[axis] = body.inverse_inertia[axis] = T(1);
  return body;
}

/// The links of these bodies, along x, y and z.
template <class T>
std::array<LinkLanes<T>, 3> row_case_links() {
  LinkLanes<T> law{};
  const auto set = [](LaneNumbers<T>& lanes, double value) {
    for (T& number : lanes.value) number = T(value);
  };
  set(law.k_s, 0.5), set(law.k_ns, 0.5), set(law.d_s, 0.125), set(law.d_ns, 0.0625);
  set(law.k_z, 0.25), set(law.k_xz, 0.125), set(law.k_yz, 0.125);
  set(law.d_z, 0.0625), set(law.d_xz, 0.03125), set(law.d_yz, 0.03125);
  return {law, law, law};
}

/// Calls stage(task) for each row, from the first to the last.
template <class T, class Stage>
void run_row_case(const RowCase& row_case, const T* in, T* out, std::size_t elements,
                  std::size_t row_elements, Stage&& stage) {
  const int packs = int(row_elements / std::size_t(row_case.lanes));
  const std::size_t rows = elements / row_elements,
                    row_size = row_elements * std::size_t(row_case.fields),
                    array_size = rows * row_size;
  const simd::LaneMask all = simd::LaneMask((1u << row_case.lanes) - 1);
  thread_local std::vector<PackMasks> masks;
  masks.assign(std::size_t(packs), PackMasks{all, all, 0, all, 0});
  const T signals[3] = {};
  const BodyConstants<T> body = row_case_body<T>();
  const auto links = row_case_links<T>();
  RowTask<T> task;
  task.action = row_case.is_last ? combined_stage : plain_stage;
  task.is_last = row_case.is_last;
  task.packs = packs;
  task.stride = row_case.fields * row_case.lanes;
  task.masks = masks.data();
  task.body = &body;
  task.links = links.data();
  task.signals = signals;
  task.beta = T(0.0625);
  if (row_case.is_last) { // (y1 + 2 y2 + y3 - y) / 3 (DESIGN.md section 3)
    task.beta = T(0.5);
    task.increments = 3;
    task.alpha[0] = T(1) / T(3), task.alpha[1] = T(2), task.alpha[2] = T(1);
  }
  T* const carry = out + array_size;
  for (std::size_t r = 0; r < rows; ++r) {
    task.in = in + r * row_size, task.ahead = task.in + row_size;
    task.upper_y = in + (r + 1) % rows * row_size;
    task.base = in + array_size + r * row_size;
    task.out = out + r * row_size;
    task.from_y = task.carry_y = carry;
    if (row_case.is_last) {
      task.increment[0] = task.base + array_size;
      task.increment[1] = task.increment[0] + array_size;
      task.increment[2] = task.in;
    }
    stage(task);
  }
}

} // namespace dss
