#include "experiments/run/plan/device_listing.hpp"
#include "experiments/run/plan/context.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr const char* device_variant = "opencl"; ///< the variant that lists the devices

Listing host_row() {
  const nlohmann::ordered_json context = measurement_context();
  return {{"device", "host"},
          {"kind", "cpu"},
          {"name", context["cpu_model"]},
          {"platform", ""},
          {"compute_units", fmt::format("{}", usable_cores())},
          {"memory_gib", fmt::format("{:.1f}", context["memory_bytes"].get<double>() / (1 << 30))},
          {"f64", "yes"},
          {"status", "usable"}};
}

Listing row_of(const DeviceEntry& device) {
  return {{"device", device.id},
          {"kind", device.kind},
          {"name", device.name},
          {"platform", device.platform},
          {"compute_units", fmt::format("{}", device.compute_units)},
          {"memory_gib", fmt::format("{:.1f}", device.memory_bytes / (1 << 30))},
          {"f64", device.has_f64 ? "yes" : "no"},
          {"status", device.unusable.empty() ? "usable" : "unusable: " + device.unusable}};
}

/// The row that stands for all devices if there are none.
Listing row_without_device(const std::string& why) {
  return {{"device", ""},        {"kind", ""},
          {"name", "OpenCL"},    {"platform", ""},
          {"compute_units", ""}, {"memory_gib", ""},
          {"f64", ""},           {"status", "unusable: " + why}};
}

void add_ceilings(const Plugin* plugin, const DeviceEntry& device, Listing& row) {
  for (const char* key : {"triad_gb_per_s", "f64_gflop_per_s", "f32_gflop_per_s"}) row[key] = "";
  if (plugin == nullptr || plugin->ceilings == nullptr || device.id.empty() ||
      !device.unusable.empty())
    return;
  const auto giga = [](double value) {
    return value > 0 ? fmt::format("{:.1f}", 1e-9 * value) : "";
  };
  try {
    const DeviceCeilings ceilings = plugin->ceilings(device.id);
    row["triad_gb_per_s"] = giga(ceilings.triad_bytes_per_s);
    row["f64_gflop_per_s"] = giga(ceilings.f64_flops_per_s);
    row["f32_gflop_per_s"] = giga(ceilings.f32_flops_per_s);
  } catch (const InputError& error) {
    row["status"] = std::string("not measured: ") + error.what();
  }
}

} // namespace

Listing device_listing(bool is_measured) {
  Listing list = Listing::array();
  const Plugin* plugin = nullptr;
  const auto add = [&](Listing row, const DeviceEntry& device) {
    if (is_measured) add_ceilings(plugin, device, row);
    list.push_back(std::move(row));
  };
  add(host_row(), {});
  const auto status = std::ranges::find(asked_variants(), device_variant, &VariantStatus::name);
  const std::string why =
      status == asked_variants().end() ? "built without the variant opencl" : status->unusable;
  std::vector<DeviceEntry> devices;
  try {
    plugin = &load_variant(device_variant);
    devices = plugin->devices();
  } catch (const InputError&) { // `why` has the reason
  }
  for (const DeviceEntry& device : devices) add(row_of(device), device);
  if (devices.empty()) add(row_without_device(why), {});
  return list;
}

} // namespace dss
