#include "experiments/measure/cell_devices.hpp"
#include "experiments/measure/study_names.hpp"
#include "solver/error.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr const char* device_variant = "opencl"; ///< the variant that lists the devices

/// Null if the variant cannot be opened here.
const Plugin* plugin_of(const std::string& variant) {
  try {
    return &load_variant(variant);
  } catch (const InputError&) {
    return nullptr;
  }
}

std::string replaced(std::string text, const std::string& word, int number) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word))
    text.replace(at, word.size(), fmt::format(":{}", number));
  return text;
}

/// @param device  may be empty: the first device of the variant, if it has devices
std::string why_no_device(const std::string& variant, const std::string& device,
                          Precision precision) {
  const Plugin* plugin = nullptr;
  try {
    plugin = &load_variant(variant);
    if (plugin->devices == nullptr) return "";
    if (const std::string why = plugin->why_unusable == nullptr ? "" : plugin->why_unusable();
        !why.empty())
      return why;
    require_precision(choose_device(plugin->devices(), device), precision);
  } catch (const InputError& error) {
    return plugin == nullptr && device.empty() ? "" : error.what();
  }
  return "";
}

} // namespace

void require_device_variant(const std::string& variant, const std::string& device,
                            const Node& place) {
  known_variant(variant, place);
  const Plugin* plugin = plugin_of(variant);
  if (!device.empty() && plugin != nullptr && plugin->devices == nullptr)
    place.fail(fmt::format(
        "variant \"{}\" runs on this CPU, and the block has the device \"{}\"; give \"{}\"",
        variant, device, device_variant));
}

std::string members_text(const Node& place, int cores) {
  const std::string text =
      replaced(replaced(place.name(), ":cores", cores), ":rest", std::max(1, cores - 1));
  if (text == "auto") return text;
  for (const Member& member : place.placed([&] { return parse_members(text); }))
    if (member.variant != "auto") require_device_variant(member.variant, member.device, place);
  return text;
}

int threads_of_members(const std::string& members) {
  int threads = 0;
  for (const Member& member : parse_members(members)) {
    const Plugin* plugin = plugin_of(member.variant);
    bool is_on_cpu = plugin == nullptr || plugin->devices == nullptr;
    if (!is_on_cpu && why_no_device(member.variant, member.device, Precision::f32).empty())
      is_on_cpu = choose_device(plugin->devices(), member.device).kind == "cpu";
    if (is_on_cpu) threads += member.threads;
  }
  return std::max(threads, 1);
}

std::string why_no_device(const Cell& cell) {
  const Precision precision = find_precision(cell.precision).value_or(Precision::f64);
  if (cell.hybrid.empty()) return why_no_device(cell.variant, cell.device, precision);
  if (!cell.device.empty())
    if (const std::string why = why_no_device(device_variant, cell.device, precision); !why.empty())
      return why;
  if (cell.hybrid == "auto") return "";
  for (const Member& member : parse_members(cell.hybrid))
    if (const std::string why = why_no_device(member.variant, member.device, precision);
        !why.empty())
      return why;
  return "";
}

std::string why_no_members(const std::string& members) {
  if (members.empty() || members == "auto") return "";
  try {
    for (const Member& member : parse_members(members)) load_variant(member.variant);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

} // namespace dss
