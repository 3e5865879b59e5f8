#pragma once
/// A kernel as a module exports it. kernels/cases.hpp lists the cases,
/// kernels/stage_row/row_case.hpp explains the rows.
#include "kernels/model.hpp"

#include <cstddef>

namespace dss {

/// One kernel over arrays, compiled for the instruction set of the module.
/// Case: operand n of element e is at [n * stride + e].
/// Row: numbers and rows are laid out as in row_case.hpp, `stride` elements a row.
struct CompiledKernel {
  const char* name;
  Model model;
  Precision precision;
  int inputs, outputs; ///< numbers an element in memory, without a row's carry buffer
  int flops;
  int lanes; ///< elements a call handles together; `elements` of run() is a multiple
  void (*run)(int kernel, const void* in, void* out, std::size_t elements, std::size_t stride);
  int index;                            ///< first argument of run
  bool is_row = false, is_last = false; ///< the fused row kernel; for the last RK4 stage
  bool is_material = false;             ///< of a row: its links have the material law
};

} // namespace dss
