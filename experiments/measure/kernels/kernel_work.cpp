#include "experiments/measure/kernels/kernel_work.hpp"
#include "kernels/stage_row/row_case.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include <sys/mman.h>

namespace dss {
namespace {

constexpr std::size_t block_elements = 64, plate_row_elements = 100, operand_rows = 16;

std::size_t number_bytes(const CompiledKernel& kernel) {
  return kernel.precision == Precision::f64 ? sizeof(double) : sizeof(float);
}

std::size_t rounded_up(std::size_t value, std::size_t unit) {
  return (value + unit - 1) / unit * unit;
}

/// Uses huge pages above 64 KiB. With small pages, chance decides which pages collide in L2, and
/// some processes are slower throughout.
std::byte* allocate(std::size_t bytes) {
  constexpr std::size_t small_page = 4096, huge_page = std::size_t(2) << 20;
  const std::size_t unit = bytes > 16 * small_page ? huge_page : small_page,
                    size = rounded_up(bytes, unit);
  void* p = std::aligned_alloc(unit, size);
  if (p == nullptr) throw std::bad_alloc();
  if (unit == huge_page) madvise(p, size, MADV_HUGEPAGE);
  return static_cast<std::byte*>(p);
}

} // namespace

KernelShape kernel_shape(const CompiledKernel& kernel, std::size_t bytes) {
  const std::size_t element = std::size_t(kernel.inputs + kernel.outputs) * number_bytes(kernel);
  const std::size_t most = std::max(bytes / element, std::size_t(1));
  const std::size_t row = !kernel.is_row || most < 2 * plate_row_elements
                              ? block_elements
                              : rounded_up(plate_row_elements, std::size_t(kernel.lanes));
  return {std::max(most / row, std::size_t(1)) * row, row};
}

double operand(int n, std::size_t element) {
  const std::size_t mixed = (element * 7919 + std::size_t(n) * 104729) % 1009;
  const double size = 0.05 + 0.45 * double(mixed) / 1009;
  return mixed % 2 == 0 ? size : -size;
}

KernelWork::KernelWork(const CompiledKernel& kernel, const KernelShape& shape)
    : kernel_(kernel), shape_(shape), size_(number_bytes(kernel)) {
  const std::size_t slack = std::size_t(kernel.inputs * kernel.lanes); // a row reads one pack ahead
  const std::size_t carry = kernel.is_row ? shape.row_elements * RowCase::most_carry : 0;
  in_.reset(allocate((shape.elements * std::size_t(kernel.inputs) + slack) * size_));
  out_.reset(allocate((shape.elements * std::size_t(kernel.outputs) + carry) * size_));
  std::fill_n(in_.get(), (shape.elements * std::size_t(kernel.inputs) + slack) * size_,
              std::byte{0});
  const std::size_t results = shape.elements * std::size_t(kernel.outputs) * size_;
  std::fill_n(out_.get(), results, std::byte{0xff}); // NaN
  std::fill_n(out_.get() + results, carry * size_, std::byte{0});
  const std::size_t period = std::min(operand_rows * shape.row_elements, shape.elements);
  for (std::size_t e = 0; e < period; ++e)
    for (int n = 0; n < kernel.inputs; ++n)
      set_number(in_.get(), place(n, e, kernel.inputs), operand(n, e));
  // Copies of these rows fill the rest, because large working sets are made anew for every sample.
  const std::size_t arrays = kernel.is_row ? std::size_t(kernel.inputs / kernel.outputs) : 1;
  const std::size_t array = shape.elements * std::size_t(kernel.inputs) / arrays * size_,
                    repeated = period * array / shape.elements;
  for (std::size_t a = 0; a < arrays; ++a)
    for (std::size_t at = repeated; at < array; at += repeated)
      std::copy_n(in_.get() + a * array, std::min(repeated, array - at),
                  in_.get() + a * array + at);
}

void KernelWork::pass() {
  if (kernel_.is_row)
    return kernel_.run(kernel_.index, in_.get(), out_.get(), shape_.elements, shape_.row_elements);
  const std::size_t in_block = std::size_t(kernel_.inputs) * block_elements * size_,
                    out_block = std::size_t(kernel_.outputs) * block_elements * size_;
  for (std::size_t block = 0; block < shape_.elements / block_elements; ++block)
    kernel_.run(kernel_.index, in_.get() + block * in_block, out_.get() + block * out_block,
                block_elements, block_elements);
}

std::size_t KernelWork::place(int n, std::size_t element, int numbers) const {
  if (!kernel_.is_row) {
    const std::size_t block = element / block_elements;
    return block * block_elements * std::size_t(numbers) + std::size_t(n) * block_elements +
           element % block_elements;
  }
  // The arrays follow each other. Each is an array of rows; a row is packs of the fields.
  const std::size_t lanes = std::size_t(kernel_.lanes), fields = std::size_t(kernel_.outputs);
  const std::size_t array = std::size_t(n) / fields * shape_.elements * fields;
  return array + (element / lanes * fields + std::size_t(n) % fields) * lanes + element % lanes;
}

double KernelWork::number(const std::byte* array, std::size_t place) const {
  return kernel_.precision == Precision::f64 ? reinterpret_cast<const double*>(array)[place]
                                             : double(reinterpret_cast<const float*>(array)[place]);
}
void KernelWork::set_number(std::byte* array, std::size_t place, double value) const {
  if (kernel_.precision == Precision::f64)
    reinterpret_cast<double*>(array)[place] = value;
  else
    reinterpret_cast<float*>(array)[place] = float(value);
}
double KernelWork::result(int n, std::size_t element) const {
  return number(out_.get(), place(n, element, kernel_.outputs));
}

} // namespace dss
