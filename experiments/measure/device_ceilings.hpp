#pragma once
/// Best rates of this machine's devices, measured in the same session as the study.
#include "experiments/base/records.hpp"
#include "experiments/measure/cell_study.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// True if any cell that is not skipped names a device. Hybrids have no ceiling.
bool uses_devices(const CellStudy& study);

/// Memory bandwidth and peak arithmetic of each device, by the device's id.
class DeviceCeilingsHere {
public:
  /// Contains no device.
  DeviceCeilingsHere() = default;
  /// Measures in a child process (`dssbench list devices --measure`), so that this process does not
  /// open the devices.
  explicit DeviceCeilingsHere(const std::string& program);
  /// Fills the columns triad_bytes_per_s and peak_flops_per_s. The peak is that of the run's
  /// precision.
  /// @param run  output of `dssbench run --json`
  void put(const nlohmann::json& run, Record& row) const;

private:
  struct Ceilings {
    double triad_bytes_per_s, f64_flops_per_s, f32_flops_per_s; ///< NaN: not measured
  };
  std::map<std::string, Ceilings> of_device_;
};

} // namespace dss
