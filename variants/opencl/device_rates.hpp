#pragma once
/// The right-hand side on a device: rates of plain rows, band by band.
#include "variants/opencl/device_problem.hpp"

namespace dss::opencl {

template <class T, int W>
class DeviceRates {
public:
  /// @param is_scaled  rates as the state's, else forces and moments as sums for a host that updates  @param part  null, or of which
  /// `problem` is one
  DeviceRates(const Problem& problem, Model model, const Part* part, const Device& device, const Layout& layout,
              bool is_scaled);
  DeviceProblem<T, W>& device() { return device_; }
  const DeviceProblem<T, W>& device() const { return device_; }
  int bands() const { return int(lists_.size()); }
  std::size_t size() const { return plain_.size(); } ///< numbers of plain rows (StateRows::plain_size)
  /// To the device, evaluation there, and back. Plain rows in, plain rows out. @param signals  one row
  void evaluate(const T* plain, std::span<const double> signals, T* rates);
  /// The last evaluation as many times again, then back unless `rates` is null; of these launches alone, since the old rates are cleared.
  void repeat(long times, T* rates);

private:
  void launch();
  std::size_t place(const dss::Buffer<T>& buffer) const {
    return std::size_t(device_.offset(buffer.data())) * sizeof(T);
  }
  void put(const dss::Buffer<T>& buffer, const T* numbers);
  void get_rates(T* rates);

  DeviceProblem<T, W> device_;
  dss::Buffer<T> plain_, rates_, zero_;
  std::vector<CarryRings<T>> carry_; ///< of each band
  std::vector<cl_int2> lists_;
  opencl::Buffer list_table_, row_starts_, failed_;
  Kernel kernel_;
};

} // namespace dss::opencl
