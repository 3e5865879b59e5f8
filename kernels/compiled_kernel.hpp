#pragma once
/// A kernel case as a module hands it out (kernels/cases.hpp has the table).
#include "solver/model/model.hpp"

#include <cstddef>

namespace dss {

/// One case compiled for the module's instruction set, over arrays: operand n of element e is at [n * stride + e].
struct CompiledKernel {
  const char* name;
  Model model;
  Precision precision;
  int inputs, outputs, flops;
  int lanes; ///< elements at a time; `elements` of run() is a multiple
  void (*run)(int kernel, const void* in, void* out, std::size_t elements, std::size_t stride);
  int index; ///< first argument of run
};

} // namespace dss
