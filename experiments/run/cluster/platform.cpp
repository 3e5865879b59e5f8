#include "experiments/base/temporary_file.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/plan/job.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/io/program_files.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

namespace fs = std::filesystem;

fs::path platform_folder() { return program_file("experiments/platforms"); }

/// Describes two ranks of this machine as two nodes. The settings are those of
/// experiments/platforms; the figures come from a ping-pong.
std::string describe_host() {
  const JobResult job = run_job(
      2, 1, {"run", "plate_paper", "--set", "n=20", "--steps", "2", "--ranks", "2", "--json", "-"});
  const auto json = nlohmann::json::parse(job.output, nullptr, false);
  if (!json.is_object())
    throw InputError(fmt::format("--platform {}: {}", host_platform, job.failure));
  const auto& network = json["network"];
  return fmt::format(
      R"(<?xml version='1.0'?>
<!DOCTYPE platform SYSTEM "https://simgrid.org/simgrid.dtd">
<platform version="4.1">
 <config>
  <prop id="network/crosstraffic" value="0"/>
  <prop id="network/TCP-gamma" value="0"/>
  <prop id="network/weight-S" value="0"/>
  <prop id="smpi/bw-factor" value="0:1"/>
  <prop id="smpi/lat-factor" value="0:1"/>
  <prop id="smpi/os" value="0:{2}:{3}"/>
  <prop id="smpi/ois" value="0:{2}:{3}"/>
  <prop id="smpi/or" value="0:{2}:{3}"/>
 </config>
 <cluster id="this_host" prefix="node" suffix="" radical="0-1023" speed="1Gf" core="1"
           bw="{1}Bps" lat="{0}s" sharing_policy="SPLITDUPLEX"/>
</platform>
)",
      network["latency_s"].get<double>() / 2, 1 / network["seconds_a_byte"].get<double>(),
      network["overhead_s"].get<double>(), network["overhead_s_a_byte"].get<double>());
}

std::string without_comments(std::string text) {
  for (std::size_t begin = text.find("<!--"); begin != std::string::npos;
       begin = text.find("<!--", begin)) {
    const std::size_t end = text.find("-->", begin);
    text.erase(begin, end == std::string::npos ? end : end + 3 - begin);
  }
  return text;
}

/// Values of an attribute: name="value".
std::vector<std::string> values_of(const std::string& text, const std::string& name) {
  constexpr const char* space = " \t\r\n";
  std::vector<std::string> values;
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::size_t equals = text.find_first_not_of(space, at + name.size());
    if (equals == std::string::npos || text[equals] != '=') continue;
    const std::size_t quote = text.find_first_not_of(space, equals + 1);
    if (at == 0 || std::strchr(space, text[at - 1]) == nullptr || quote == std::string::npos)
      continue;
    const std::size_t end = text.find(text[quote], quote + 1);
    values.push_back(text.substr(quote + 1, end - quote - 1));
  }
  return values;
}

/// SimGrid takes a latency that is not a number, or is negative, and simulates something.
/// @throws InputError for a speed, bandwidth or latency that no machine has
void require_sound_numbers(const std::string& path) {
  const std::string text = without_comments(read_text(path));
  for (const char* name : {"bw", "bandwidth", "lat", "latency", "speed"})
    for (const std::string& value : values_of(text, name)) {
      const double number = std::strtod(value.c_str(), nullptr);
      const bool may_be_zero = name[0] == 'l' && value.starts_with('0');
      if (!std::isfinite(number) || number < 0 || (number == 0 && !may_be_zero))
        throw InputError(fmt::format("--platform {}: {}=\"{}\" is no positive number with a "
                                     "unit, such as bw=\"1150MBps\", lat=\"6us\" or "
                                     "speed=\"1Gf\"",
                                     path, name, value.substr(0, 40)));
    }
}

} // namespace

std::vector<std::string> Platform::names() {
  std::vector<std::string> names{host_platform};
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(platform_folder(), error))
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

void Platform::require_known(const std::string& name_or_path) {
  if (name_or_path == host_platform) {
    if (const std::string why = why_no_ranks(); !why.empty())
      throw InputError(fmt::format("--platform {}: {}", host_platform, why));
    return;
  }
  if (name_or_path.ends_with(".xml") && fs::exists(name_or_path))
    return require_sound_numbers(name_or_path);
  if (fs::exists(platform_folder() / (name_or_path + ".xml"))) return;
  throw InputError(fmt::format("--platform {}: no such platform; {}", name_or_path,
                               nearest_name(name_or_path, names())));
}

Platform::Platform(const std::string& name_or_path) : path_(name_or_path) {
  require_known(name_or_path);
  if (name_or_path == host_platform) {
    const auto file = std::make_shared<const TemporaryFile>(describe_host(), ".xml");
    path_ = file->path();
    temporary_ = file;
  } else if (!name_or_path.ends_with(".xml")) {
    path_ = (platform_folder() / (name_or_path + ".xml")).string();
  }
}

} // namespace dss
