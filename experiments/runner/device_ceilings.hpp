#pragma once
/// What the devices of this machine can do at best, measured in the session of a study.
#include "experiments/runner/records.hpp"
#include "experiments/runner/study.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace dss {

/// Whether any cell computes on a device that is here. Hybrids have no ceiling.
bool uses_devices(const Study& study);

/// By device.
class DeviceCeilingsHere {
public:
  /// Of no device.
  DeviceCeilingsHere() = default;
  /// Measured in a process of its own (`dssbench list devices --measure`), so that this one leaves devices alone.
  explicit DeviceCeilingsHere(const std::string& program);
  /// Fills triad_bytes_per_s and peak_flops_per_s of a repetition, that of its precision, as `dssbench run --json` says.
  void put(const nlohmann::json& run, Record& row) const;

private:
  struct Ceilings {
    double triad_bytes_per_s, f64_flops_per_s, f32_flops_per_s; ///< NaN: not measured
  };
  std::map<std::string, Ceilings> of_device_;
};

} // namespace dss
