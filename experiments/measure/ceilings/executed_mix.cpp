#include "experiments/measure/ceilings/executed_mix.hpp"
#include "experiments/base/child.hpp"
#include "experiments/measure/kernels/kernel_work.hpp"
#include "solver/error.hpp"
#include "variants/isa/machine_code.hpp"

#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <fmt/format.h>
#include <map>
#include <sstream>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dss {
namespace {

constexpr double objdump_limit_s = 120;
/// Packs of the two rows that are traced. The difference of their counts has no set-up cost of a
/// row.
constexpr std::size_t short_row = 4, long_row = 12;

/// number of executions, by address in the module
using Executions = std::map<std::uint64_t, long>;

/// Body of the traced process: it stops before and after the pass over each of two rows.
[[noreturn]] void run_stops(KernelWork& first, KernelWork& second) {
  if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(1);
  for (KernelWork* work : {&first, &second}) {
    work->pass(); // the first pass also binds symbols; it is not counted
    ::raise(SIGSTOP);
    work->pass();
    ::raise(SIGSTOP);
  }
  ::_exit(0);
}

/// Single-steps to the next stop. Adds `sign` to the count of each executed address, relative to
/// `base`.
void step_to_stop(pid_t child, std::uint64_t base, std::uint64_t size, long sign,
                  Executions& executions) {
  for (int status = 0;;) {
    if (::ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) != 0 ||
        ::waitpid(child, &status, 0) != child || !WIFSTOPPED(status))
      throw InputError("instruction mix: the traced process ended");
    if (WSTOPSIG(status) == SIGSTOP) return;
    if (WSTOPSIG(status) != SIGTRAP)
      throw InputError(
          fmt::format("instruction mix: the traced process got signal {}", WSTOPSIG(status)));
    const std::uint64_t address = program_counter(child) - base;
    if (address < size) executions[address] += sign;
  }
}

void continue_to_stop(pid_t child) {
  int status = 0;
  if (::ptrace(PTRACE_CONT, child, nullptr, nullptr) != 0 ||
      ::waitpid(child, &status, 0) != child || !WIFSTOPPED(status))
    throw InputError("instruction mix: the traced process ended");
}

Executions trace(const CompiledKernel& kernel, std::uint64_t base, std::uint64_t size) {
  const std::size_t lanes = std::size_t(kernel.lanes);
  KernelWork first(kernel, {short_row * lanes, short_row * lanes}),
      second(kernel, {long_row * lanes, long_row * lanes});
  const pid_t child = ::fork();
  if (child < 0) throw InputError("instruction mix: cannot start a process");
  if (child == 0) run_stops(first, second);
  Executions executions;
  int status = 0;
  try {
    if (::waitpid(child, &status, 0) != child || !WIFSTOPPED(status))
      throw InputError("instruction mix: this system does not let a process be traced");
    ::ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_EXITKILL);
    step_to_stop(child, base, size, -1, executions);
    continue_to_stop(child);
    step_to_stop(child, base, size, 1, executions);
  } catch (...) {
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    throw;
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
  return executions;
}

/// The disassembly of an address range of a module, one instruction per line.
std::string disassembly(const std::string& module, std::uint64_t first, std::uint64_t last) {
  const ChildResult child = run_child("/usr/bin/env",
                                      {"env", "objdump", "-d", "--no-show-raw-insn",
                                       fmt::format("--start-address={}", first),
                                       fmt::format("--stop-address={}", last + 1), module},
                                      objdump_limit_s);
  if (child.exit_code != 0)
    throw InputError(fmt::format("objdump (binutils): {}", child.failure(objdump_limit_s)));
  return child.output;
}

InstructionMix looked_up(const std::string& module, const Executions& executions, double packs) {
  // Distant functions are disassembled separately: a whole module takes seconds.
  constexpr std::uint64_t gap = 4096;
  InstructionMix mix;
  for (auto first = executions.begin(); first != executions.end();) {
    auto last = first;
    for (auto next = std::next(first); next != executions.end() && next->first - last->first < gap;
         ++next)
      last = next;
    std::istringstream lines(disassembly(module, first->first, last->first));
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(":\t");
      if (colon == std::string::npos) continue;
      const auto found = executions.find(std::strtoull(line.c_str(), nullptr, 16));
      if (found != executions.end())
        count_instruction(line.substr(colon + 2), double(found->second) / packs, mix);
    }
    first = std::next(last);
  }
  return mix;
}

} // namespace

InstructionMix executed_mix(const CompiledKernel& kernel) {
  Dl_info module{};
  if (::dladdr(reinterpret_cast<const void*>(kernel.run), &module) == 0)
    throw InputError("instruction mix: the kernel's module is not known");
  constexpr std::uint64_t most_text = 64u << 20;
  const Executions executions =
      trace(kernel, reinterpret_cast<std::uint64_t>(module.dli_fbase), most_text);
  const InstructionMix mix = looked_up(module.dli_fname, executions, double(long_row - short_row));
  if (mix.fma + mix.sums + mix.products == 0)
    throw InputError("instruction mix: the disassembly does not show what ran");
  return mix;
}

} // namespace dss
