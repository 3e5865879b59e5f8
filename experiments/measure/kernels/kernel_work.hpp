#pragma once
/// A compiled kernel with operands of its own.
#include "experiments/measure/kernels/micro_work.hpp"
#include "kernels/compiled_kernel.hpp"

#include <cstddef>
#include <memory>

namespace dss {

/// Number of elements of the operands. A case has one array per operand, in blocks of elements. A
/// row kernel has packs of all fields.
struct KernelShape {
  /// all elements; elements of a row, or of a block of a case
  std::size_t elements = 0, row_elements = 0;
};

/// Largest shape that fits in `bytes`, and at least one row or block. Cases have blocks of 64
/// elements. Rows have 64 elements if the working set is small (L1), else about 100.
KernelShape kernel_shape(const CompiledKernel& kernel, std::size_t bytes);

/// Operand n of an element: between -0.5 and 0.5, at least 0.05 in size, the same for every
/// variant.
double operand(int n, std::size_t element);

/// Runs a kernel on its working set, and gives access to the results.
class KernelWork : public MicroWork {
public:
  KernelWork(const CompiledKernel& kernel, const KernelShape& shape);
  void pass() override;
  /// Result n of an element after a pass.
  double result(int n, std::size_t element) const;

private:
  std::size_t place(int n, std::size_t element, int numbers) const;
  double number(const std::byte* array, std::size_t place) const;
  void set_number(std::byte* array, std::size_t place, double value) const;

  const CompiledKernel& kernel_;
  const KernelShape shape_;
  std::size_t size_; ///< bytes of a number
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  std::unique_ptr<std::byte, Free> in_, out_;
};

} // namespace dss
