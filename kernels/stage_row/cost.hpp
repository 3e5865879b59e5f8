#pragma once
/// Declared cost of the fused row kernel; a test counts the operations.
#include "solver/model/model.hpp"

namespace dss {

/// Flops an element and stage: paper's law, damped, no bending, equal edges, in the interior of a plate (two links an
/// element). A fused multiply-add counts two. `stage`: out = y + beta f; `last_stage`: with three increments and the
/// check for finite numbers.
struct RowFlops {
  int stage, last_stage;
  constexpr int rk4_step() const { return 3 * stage + last_stage; }
};
constexpr RowFlops row_flops(Model model) { return model == Model::spatial ? RowFlops{218, 347} : RowFlops{79, 148}; }

} // namespace dss
