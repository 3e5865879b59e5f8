#include "experiments/run/plan/context.hpp"
#include "experiments/base/build_info.hpp"
#include "solver/cores.hpp"
#include "solver/io/atomic_file.hpp"
#include "variants/isa/denormals.hpp"
#include "variants/loading/loader.hpp"

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <functional>
#include <sched.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace dss {
namespace {

using Json = nlohmann::ordered_json;

std::string first_line(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string cpuinfo(const std::string& key) {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.rfind(key, 0) == 0) {
      const auto colon = line.find(": ");
      return colon == std::string::npos ? "" : line.substr(colon + 2);
    }
  return "";
}

Json caches() {
  Json list = Json::array();
  std::error_code error;
  for (int index = 0;; ++index) {
    const std::filesystem::path cache =
        fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}", index);
    if (!std::filesystem::exists(cache, error)) return list;
    const std::string size = first_line(cache / "size"), level = first_line(cache / "level");
    const std::string shared = first_line(cache / "shared_cpu_list");
    list.push_back({{"type", first_line(cache / "type")},
                    {"level", std::atoi(level.c_str())},
                    {"size", std::atol(size.c_str()) * 1024}, // the kernel prints "32K"
                    {"shared_cpu_list", shared}});
  }
}

Json library_versions() {
  return {{"cli11", CLI11_VERSION},
          {"eigen",
           fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                              FMT_VERSION % 100)},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                        NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)}};
}

/// Digests of variants outside this tree: no commit identifies their code.
Json digests_of_outside_variants() {
  Json digests;
  for (const VariantStatus& variant : variants())
    if (variant.is_outside() && variant.is_usable())
      digests[variant.name] =
          fmt::format("{:016x}", std::hash<std::string>{}(read_text(variant.path)));
  return digests;
}

} // namespace

std::string measurement_time() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

nlohmann::ordered_json measurement_context() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  std::array<double, 3> load{};
  const int loads = ::getloadavg(load.data(), 3);
  const BuildInfo& build = build_info();
  const char* omp_binding = std::getenv("OMP_PROC_BIND");
  const std::string governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  Json context;
  context["date"] = measurement_time();
  context["host_name"] = host.data();
  context["executable"] = "dssbench";
  context["num_cpus"] = ::sysconf(_SC_NPROCESSORS_ONLN);
  context["mhz_per_cpu"] = std::atof(cpuinfo("cpu MHz").c_str());
  context["cpu_scaling_enabled"] = !governor.empty() && governor != "performance";
  context["caches"] = caches();
  context["load_avg"] = std::vector<double>(load.begin(), load.begin() + (loads > 0 ? loads : 0));
  context["library_build_type"] = build.build_type;
  context["cpu_model"] = cpuinfo("model name");
  context["cpu_flags"] = cpuinfo("flags");
  context["memory_bytes"] = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGE_SIZE));
  context["kernel"] = first_line("/proc/sys/kernel/osrelease");
  context["git_commit"] = build.git_commit;
  context["git_dirty"] = build.git_dirty;
  context["compiler"] = build.compiler;
  context["compiler_flags"] = build.flags;
  context["build_type"] = build.build_type;
  context["libraries"] = library_versions();
  context["packages"] = build.packages;
  context["affinity"] = affinity();
  context["omp_proc_bind"] = omp_binding == nullptr ? "" : omp_binding;
  context["denormals_flushed"] = are_denormals_flushed();
  if (const Json outside = digests_of_outside_variants(); !outside.empty())
    context["outside_variants"] = outside;
  return context;
}

} // namespace dss
