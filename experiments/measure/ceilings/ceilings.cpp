#include "experiments/measure/ceilings/ceilings.hpp"
#include "experiments/base/child.hpp"
#include "experiments/measure/ceilings/own_ceilings.hpp"
#include "experiments/measure/kernels/working_set.hpp"
#include "solver/cores.hpp"
#include "variants/isa/instruction_set.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

constexpr double likwid_sample_s = 0.2, likwid_limit_s = 60;

std::string likwid_bench() {
  for (const char* path : {"/usr/bin/likwid-bench", "/usr/local/bin/likwid-bench"})
    if (std::filesystem::exists(path)) return path;
  return "";
}

/// The number after a label in the output of likwid-bench, or NaN.
double number_after(const std::string& text, const std::string& label) {
  const std::size_t at = text.find(label);
  return at == std::string::npos ? std::nan("") : std::atof(text.c_str() + at + label.size());
}

/// Guessed rate of one thread: likwid-bench counts iterations per thread.
double guessed_bytes_per_s(const Ceiling& ceiling) {
  if (ceiling.is_flops) return ceiling.isa == "scalar" ? 4e9 : 25e9;
  return ceiling.level == "L1"   ? 300e9
         : ceiling.level == "L2" ? 90e9
         : ceiling.level == "L3" ? 20e9
                                 : 10e9;
}

void run_likwid(const std::string& program, Ceiling& ceiling) {
  // The number of iterations is guessed so that a sample lasts long enough. If the guess was far
  // off, the run is repeated with the measured rate.
  double iterations = std::max(10.0, std::ceil(likwid_sample_s * guessed_bytes_per_s(ceiling) /
                                               double(ceiling.working_set_bytes)));
  for (int attempt = 0; attempt < 3; ++attempt) {
    const std::vector<std::string> arguments{
        "likwid-bench",
        "-t",
        ceiling.benchmark,
        "-w",
        fmt::format("S0:{}kB:{}", ceiling.working_set_bytes * std::size_t(ceiling.threads) / 1000,
                    ceiling.threads),
        "-i",
        fmt::format("{:.0f}", iterations)};
    const ChildResult child = run_child(program, arguments, likwid_limit_s);
    ceiling.command = fmt::format("{} {} {} {} {} {} {}", arguments[0], arguments[1], arguments[2],
                                  arguments[3], arguments[4], arguments[5], arguments[6]);
    ceiling.per_s = 1e6 * number_after(child.output, ceiling.is_flops ? "MFlops/s:" : "MByte/s:");
    const double time = number_after(child.output, "Time:");
    if (child.exit_code != 0 || !(ceiling.per_s > 0)) {
      ceiling.per_s = std::nan("");
      ceiling.reason = fmt::format("likwid-bench: {}", child.failure(likwid_limit_s));
      return;
    }
    if (time >= likwid_sample_s / 4) return;
    iterations =
        std::ceil(iterations * std::min(1e5, 1.2 * likwid_sample_s / std::max(time, 1e-7)));
  }
}

void run_own(Ceiling& ceiling) {
  ceiling.tool = "own";
  ceiling.command = "dssbench bench --ceilings";
  const InstructionSet& isa = instruction_set(ceiling.isa);
  try {
    ceiling.per_s =
        ceiling.is_flops
            ? own_peak_flops(isa, ceiling.precision == "f64", ceiling.threads)
            : own_bandwidth(isa, ceiling.benchmark, ceiling.working_set_bytes, ceiling.threads);
  } catch (const std::exception& error) {
    ceiling.per_s = std::nan("");
    ceiling.reason = error.what();
  }
}

std::vector<Ceiling> wanted(const std::vector<int>& threads) {
  std::vector<Ceiling> list;
  InstructionSet widest = instruction_sets().front();
  for (const InstructionSet& isa : instruction_sets()) {
    if (!isa.is_here()) continue;
    widest = isa;
    for (const int count : threads)
      for (const bool is_single : {false, true})
        list.push_back({true, is_single ? isa.peak_f32 : isa.peak_f64, isa.name,
                        is_single ? "f32" : "f64", "", working_set("L1", 1).bytes, count, 0,
                        "likwid-bench", "", ""});
  }
  for (const std::string& level : memory_levels)
    for (const int count : threads)
      for (const char* access : {"load", "copy", "triad"}) {
        const WorkingSet set = working_set(level, count);
        list.push_back({false, std::string(access) + widest.stream_suffix, widest.name, "", level,
                        set.bytes, count, std::nan(""), "likwid-bench", "", set.unusable});
      }
  return list;
}

double best(const std::vector<Ceiling>& ceilings, auto&& suits) {
  double most = std::nan("");
  for (const Ceiling& ceiling : ceilings)
    if (suits(ceiling) && !std::isnan(ceiling.per_s)) most = std::fmax(most, ceiling.per_s);
  return most;
}

/// Adds OpenCL devices, measured by the variant's own kernels. A CPU device uses all its cores.
void add_devices(std::vector<Ceiling>& ceilings) {
  for (const VariantStatus& variant : asked_variants()) {
    if (!variant.is_usable()) continue;
    const Plugin& plugin = load_variant(variant.name);
    if (plugin.ceilings == nullptr || plugin.devices == nullptr) continue;
    for (const DeviceEntry& device : plugin.devices()) {
      if (!device.unusable.empty()) continue;
      const DeviceCeilings measured = plugin.ceilings(device.id);
      const int threads = device.kind == "cpu" ? usable_cores() : 1;
      const auto add = [&](bool is_flops, const char* precision, double per_s) {
        ceilings.push_back({is_flops, device.name, "opencl", precision, is_flops ? "" : "memory", 0,
                            threads, per_s > 0 ? per_s : std::nan(""), "own",
                            "dssbench list devices --measure", ""});
      };
      add(true, "f64", measured.f64_flops_per_s);
      add(true, "f32", measured.f32_flops_per_s);
      add(false, "", measured.triad_bytes_per_s);
    }
    return; // other variants on devices have the same devices
  }
}

} // namespace

std::vector<Ceiling> measure_ceilings(const std::vector<int>& threads,
                                      const std::function<void(const std::string&)>& note) {
  const std::string program = likwid_bench();
  std::vector<Ceiling> ceilings = wanted(threads);
  for (Ceiling& ceiling : ceilings) {
    if (!ceiling.reason.empty()) continue;
    if (!program.empty()) run_likwid(program, ceiling);
    if (program.empty() || std::isnan(ceiling.per_s)) run_own(ceiling);
    note(fmt::format("ceiling {} {} {}, {} threads: {:.1f} {} ({})", ceiling.benchmark,
                     ceiling.precision, ceiling.level, ceiling.threads, 1e-9 * ceiling.per_s,
                     ceiling.is_flops ? "GFLOP/s" : "GB/s", ceiling.tool));
  }
  add_devices(ceilings);
  return ceilings;
}

Table ceiling_table(const std::vector<Ceiling>& ceilings) {
  Table table{{"kind", "benchmark", "isa", "precision", "level", "working_set_bytes", "threads",
               "measured_per_s", "tool", "command", "status", "reason"},
              {}};
  for (const Ceiling& c : ceilings)
    table.rows.push_back({{"kind", c.is_flops ? "flops" : "bytes"},
                          {"benchmark", c.benchmark},
                          {"isa", c.isa},
                          {"precision", c.precision},
                          {"level", c.level},
                          {"working_set_bytes", fmt::format("{}", c.working_set_bytes)},
                          {"threads", fmt::format("{}", c.threads)},
                          {"measured_per_s", number_text(c.per_s)},
                          {"tool", c.tool},
                          {"command", c.command},
                          {"status", std::isnan(c.per_s) ? "unavailable" : "ok"},
                          {"reason", c.reason}});
  return table;
}

std::vector<Ceiling> read_ceilings(const Table& table) {
  std::vector<Ceiling> ceilings;
  for (const Record& row : table.rows)
    ceilings.push_back({text_in(row, "kind") == "flops", text_in(row, "benchmark"),
                        text_in(row, "isa"), text_in(row, "precision"), text_in(row, "level"),
                        std::size_t(number_in(row, "working_set_bytes")),
                        int(number_in(row, "threads")), number_in(row, "measured_per_s"),
                        text_in(row, "tool"), text_in(row, "command"), text_in(row, "reason")});
  return ceilings;
}

double peak_flops(const std::vector<Ceiling>& ceilings, const std::string& isa,
                  const std::string& precision, int threads) {
  return best(ceilings, [&](const Ceiling& c) {
    return c.is_flops && c.isa == isa && c.precision == precision && c.threads == threads;
  });
}

double bandwidth(const std::vector<Ceiling>& ceilings, const std::string& level, int threads) {
  return best(ceilings, [&](const Ceiling& c) {
    return !c.is_flops && c.isa != "opencl" && c.level == level && c.threads == threads;
  });
}

std::string why_no_counters() {
  const std::string program = "/usr/bin/likwid-perfctr";
  if (!std::filesystem::exists(program)) return "likwid-perfctr is not installed";
  const ChildResult child =
      run_child(program, {"likwid-perfctr", "-C", "0", "-g", "FLOPS_DP", "true"}, likwid_limit_s);
  return child.exit_code == 0 ? "" : "likwid-perfctr: no access to hardware counters here";
}

} // namespace dss
