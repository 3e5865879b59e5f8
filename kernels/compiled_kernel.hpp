#pragma once
/// A kernel as a module hands it out (kernels/cases.hpp has the table of cases, kernels/stage_row/row_case.hpp the rows).
#include "solver/model/model.hpp"

#include <cstddef>

namespace dss {

/// One kernel compiled for the module's instruction set, over arrays.
/// A case: operand n of element e is at [n * stride + e].
/// A row: numbers and rows as row_case.hpp says, `stride` elements a row.
struct CompiledKernel {
  const char* name;
  Model model;
  Precision precision;
  int inputs, outputs; ///< numbers an element in memory; a row's carry buffer is not among them
  int flops;
  int lanes; ///< elements at a time; `elements` of run() is a multiple
  void (*run)(int kernel, const void* in, void* out, std::size_t elements, std::size_t stride);
  int index;                            ///< first argument of run
  bool is_row = false, is_last = false; ///< the fused row kernel; of the last RK4 stage
};

} // namespace dss
