#pragma once
/// Random operands for kernel cases: aligned for packs, with poison around them.
#include "kernels/compiled_kernel.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

namespace dss::test {

template <class T>
class Operands {
public:
  static constexpr std::size_t elements = 1024; // a multiple of every variant's lanes
  Operands(int inputs, int outputs)
      : outputs_(outputs), in_(std::size_t(inputs) * elements + line) {
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal(0, 0.3);
    for (std::size_t n = 0; n < std::size_t(inputs) * elements; ++n)
      aligned(in_)[n] = T(normal(generator));
  }
  const T* inputs() const { return aligned(in_); }
  T input(int n, std::size_t element) const {
    return aligned(in_)[std::size_t(n) * elements + element];
  }
  std::size_t output_count() const { return std::size_t(outputs_) * elements; }
  std::vector<T> run(const CompiledKernel& kernel) const {
    std::vector<T> out(output_count() + line, std::numeric_limits<T>::quiet_NaN());
    kernel.run(kernel.index, inputs(), aligned(out), elements, elements);
    return {aligned(out), aligned(out) + output_count()};
  }

private:
  static constexpr std::size_t line = 64 / sizeof(T);
  static T* aligned(const std::vector<T>& v) {
    void* p = const_cast<T*>(v.data());
    std::size_t space = v.size() * sizeof(T);
    return static_cast<T*>(std::align(64, 1, p, space));
  }
  int outputs_;
  std::vector<T> in_;
};

/// Counts numbers whose bits differ. (NaN differs from everything.)
template <class T>
std::size_t count_differing(const std::vector<T>& a, const std::vector<T>& b) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) count += !(a[n] == b[n]);
  return count;
}

} // namespace dss::test
