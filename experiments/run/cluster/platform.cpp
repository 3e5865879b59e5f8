#include "experiments/base/temporary_file.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/plan/job.hpp"
#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
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
  if (name_or_path.ends_with(".xml") && fs::exists(name_or_path)) return;
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
