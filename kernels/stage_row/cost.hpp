#pragma once
/// Declared cost of the fused row kernel. A test counts the operations.
#include "kernels/model.hpp"

namespace dss {

/// Flops an element and stage, for the paper's law, damped, without bending, equal edges, in the
/// interior of a plate (two links an element). A fused multiply-add counts two. `stage` is
/// out = y + beta f; `last_stage` has three increments and the check for finite numbers.
struct RowFlops {
  int stage, last_stage;
  constexpr int rk4_step() const { return 3 * stage + last_stage; }
};
/// Declared flops of a model.
constexpr RowFlops row_flops(Model model) {
  switch (model) {
  case Model::axial:
    return {11, 31};
  case Model::bending:
    return {59, 119};
  case Model::membrane:
    return {60, 120};
  case Model::planar:
    return {79, 148};
  case Model::linear:
    return {123, 243};
  case Model::small:
    return {165, 285};
  case Model::spatial:
    break;
  }
  return {218, 347};
}

} // namespace dss
