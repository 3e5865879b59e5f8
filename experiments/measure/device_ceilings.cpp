#include "experiments/measure/device_ceilings.hpp"
#include "experiments/base/child.hpp"

#include <algorithm>

namespace dss {
namespace {

constexpr double time_limit_s = 120;

/// Reads a number in units of 1e9. Its JSON value is a text, which may be empty.
double giga(const nlohmann::json& device, const char* key) {
  return 1e9 * number_in({{key, device.value(key, "")}}, key);
}

} // namespace

bool uses_devices(const CellStudy& study) {
  return std::ranges::any_of(study.cells, [](const Cell& cell) {
    return cell.skipped.empty() && !cell.device.empty() && cell.hybrid.empty();
  });
}

DeviceCeilingsHere::DeviceCeilingsHere(const std::string& program) {
  const ChildResult child =
      run_child(program, {"dssbench", "list", "devices", "--measure", "--json"}, time_limit_s);
  const nlohmann::json devices = nlohmann::json::parse(child.output, nullptr, false);
  if (!devices.is_array()) return;
  for (const nlohmann::json& device : devices)
    of_device_[device.value("device", "")] = {giga(device, "triad_gb_per_s"),
                                              giga(device, "f64_gflop_per_s"),
                                              giga(device, "f32_gflop_per_s")};
}

void DeviceCeilingsHere::put(const nlohmann::json& run, Record& row) const {
  if (!run.contains("device") || !run["device"].is_object() || run.value("variant", "") == "hybrid")
    return;
  const auto found = of_device_.find(run["device"].value("id", ""));
  if (found == of_device_.end()) return;
  const Ceilings& ceilings = found->second;
  row["triad_bytes_per_s"] = number_text(ceilings.triad_bytes_per_s);
  row["peak_flops_per_s"] = number_text(
      run.value("precision", "") != "f64" ? ceilings.f32_flops_per_s : ceilings.f64_flops_per_s);
}

} // namespace dss
