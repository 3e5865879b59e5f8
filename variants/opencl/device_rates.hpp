#pragma once
/// The right-hand side on a device: computes rates of plain rows, band by band.
#include "variants/opencl/device_problem.hpp"

namespace dss::opencl {

/// Evaluates the right-hand side of a problem on a device.
template <class T, int W>
class DeviceRates {
public:
  /// @param part       null, or the part that `problem` is
  /// @param is_scaled  true: rates as of the state. false: sums of forces and moments, for a host
  ///   that updates
  DeviceRates(const Problem& problem, Model model, const Part* part, const Device& device,
              const Layout& layout, bool is_scaled);
  DeviceProblem<T, W>& device() { return device_; }
  const DeviceProblem<T, W>& device() const { return device_; }
  int bands() const { return int(lists_.back().size()); }
  /// Numbers in plain rows (StateRows::plain_size).
  std::size_t size() const { return plain_.size(); }
  /// Copies plain rows to the device, evaluates there, and copies plain rates back.
  /// @param signals  one row
  void evaluate(const T* plain, std::span<const double> signals, T* rates);
  /// Repeats the last evaluation `times` times, and then copies the rates back unless `rates` is
  /// null. Old rates are cleared first, so the result comes from these launches alone.
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
  /// Of the pressures, if elements have any, and of the rates: the list of each band.
  std::vector<std::vector<cl_int2>> lists_;
  std::vector<opencl::Buffer> list_tables_;
  opencl::Buffer row_starts_, failed_;
  Kernel kernel_;
};

} // namespace dss::opencl
