#include "variants/api/device.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr const char* kinds[] = {"gpu", "accelerator", "cpu"}; ///< in order of preference

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_kind(const std::string& text) {
  return std::find(std::begin(kinds), std::end(kinds), text) != std::end(kinds);
}

/// The first usable device that matches, else the first that matches; null if none matches.
template <class Matches>
const DeviceEntry* first_of(const std::vector<DeviceEntry>& devices, Matches&& matches) {
  const DeviceEntry* found = nullptr;
  for (const DeviceEntry& device : devices)
    if (matches(device) &&
        (found == nullptr || (!found->unusable.empty() && device.unusable.empty())))
      found = &device;
  return found;
}

const DeviceEntry* find(const std::vector<DeviceEntry>& devices, const std::string& text) {
  if (text.empty()) {
    const DeviceEntry* found = nullptr;
    for (const char* kind : kinds)
      if (found == nullptr || !found->unusable.empty())
        if (const auto* of_kind =
                first_of(devices, [&](const DeviceEntry& device) { return device.kind == kind; }))
          found = of_kind;
    return found;
  }
  const std::string asked = lower(text);
  const auto is_kind_or_id = [&](const DeviceEntry& device) {
    return device.kind == asked || device.id == asked;
  };
  if (const DeviceEntry* found = first_of(devices, is_kind_or_id)) return found;
  if (is_kind(asked)) return nullptr;
  return first_of(devices, [&](const DeviceEntry& device) {
    return lower(device.name).find(asked) != std::string::npos ||
           lower(device.platform).find(asked) != std::string::npos;
  });
}

} // namespace

const DeviceEntry& choose_device(const std::vector<DeviceEntry>& devices, const std::string& text) {
  const std::string option = text.empty() ? "" : fmt::format("--device {}: ", text);
  if (devices.empty())
    throw InputError(option + "no OpenCL device here; `dssbench list devices` says what is there");
  const DeviceEntry* found = find(devices, text);
  if (found == nullptr) {
    std::vector<std::string> known;
    for (const DeviceEntry& device : devices) {
      known.push_back(device.id);
      for (const std::string& name : {device.kind, device.name})
        if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
    }
    // Suggest no spelling for a kind: "cpu" is not a misspelt "gpu".
    throw InputError(fmt::format("{}no such device; {}", option,
                                 nearest_name(is_kind(lower(text)) ? "" : text, known)));
  }
  if (!found->unusable.empty())
    throw InputError(fmt::format("{}device {} ({}) cannot be used: {}", option, found->id,
                                 found->name, found->unusable));
  return *found;
}

void require_precision(const DeviceEntry& device, Precision precision) {
  if (precision == Precision::f64 && !device.has_f64)
    throw InputError(
        fmt::format("--precision f64: device {} ({}) has no double precision; give --precision f32",
                    device.id, device.name));
}

DeviceUse& DeviceUse::operator+=(const DeviceUse& other) {
  if (other.device.id.empty()) return *this;
  is_cached = other.is_cached && (device.id.empty() || is_cached);
  if (device.id.empty()) device = other.device, launch_s = other.launch_s;
  build_s += other.build_s;
  launches += other.launches;
  to_device_bytes += other.to_device_bytes, from_device_bytes += other.from_device_bytes;
  transfer_s += other.transfer_s;
  return *this;
}

} // namespace dss
