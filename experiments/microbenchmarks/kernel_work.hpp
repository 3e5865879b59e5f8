#pragma once
/// A compiled kernel with operands of its own.
#include "experiments/microbenchmarks/micro_case.hpp"

#include <cstddef>
#include <memory>

namespace dss {

/// Where a number of the operands lies, whatever the lanes: cases have one array a number, in blocks of elements; rows have packs.
struct KernelShape {
  std::size_t elements = 0, row_elements = 0; ///< all; of a row, or of a block of a case
};

/// The shape that fills so many bytes: cases in blocks of 64 elements, rows of 64 elements in L1 and of about 100 elsewhere.
KernelShape kernel_shape(const CompiledKernel& kernel, std::size_t bytes);

/// Numbers between -1/2 and 1/2, none of them small, the same for every variant: operand n of element e.
double operand(int n, std::size_t element);

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
  std::size_t size_; ///< of a number
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  std::unique_ptr<std::byte, Free> in_, out_;
};

/// Largest relative error of a pass over two rows, or a block, against long double; relative to the largest result of an element, or
/// a sixteenth of its largest operand where results cancel.
double kernel_error(const CompiledKernel& kernel);

} // namespace dss
