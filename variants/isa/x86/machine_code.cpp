#include "variants/isa/machine_code.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <initializer_list>
#include <sstream>
#include <sys/ptrace.h>
#include <sys/user.h>

namespace dss {
namespace {

bool begins_with_any(const std::string& text, std::initializer_list<const char*> heads) {
  return std::ranges::any_of(heads, [&](const char* head) { return text.starts_with(head); });
}

/// Counts what an instruction does with memory.
/// @param name  of the operation, without the v of its vector form
void count_memory(const std::string& operation, const std::string& name,
                  const std::string& operands, double count, InstructionMix& mix) {
  const bool is_memory = operands.find('(') != std::string::npos &&
                         !begins_with_any(operation, {"lea", "nop", "prefetch"});
  if (!is_memory) return;
  const bool is_stack = operands.find("(%rsp") != std::string::npos;
  const bool is_store =
      operands.ends_with(')') && !begins_with_any(operation, {"cmp", "test", "ucomi", "comi"});
  const bool is_load = !is_store || !begins_with_any(name, {"mov", "kmov"});
  if (is_load) mix.loads += count, mix.stack_loads += is_stack ? count : 0;
  if (is_store) mix.stores += count, mix.stack_stores += is_stack ? count : 0;
}

} // namespace

void count_instruction(const std::string& text, double count, InstructionMix& mix) {
  std::istringstream words(text);
  std::string operation, operands;
  words >> operation >> operands;
  const std::string name = operation.starts_with('v') ? operation.substr(1) : operation;
  const bool is_floating =
      name.ends_with("pd") || name.ends_with("ps") || name.ends_with("sd") || name.ends_with("ss");
  if (begins_with_any(name, {"fmadd", "fmsub", "fnmadd", "fnmsub"}))
    mix.fma += count;
  else if (is_floating && begins_with_any(name, {"add", "sub", "max", "min"}))
    mix.sums += count;
  else if (is_floating && begins_with_any(name, {"mul", "div", "sqrt"}))
    mix.products += count;
  else if (begins_with_any(name, {"align", "perm", "shuf", "unpck", "palignr", "insertf",
                                  "extractf", "movddup"}))
    mix.shuffles += count;
  else
    mix.rest += count;
  count_memory(operation, name, operands, count, mix);
}

std::uint64_t program_counter(pid_t process) {
  user_regs_struct registers{};
  ::ptrace(PTRACE_GETREGS, process, nullptr, &registers);
  return registers.rip;
}

/// %rdx counts turns.
std::string stream_loop(const std::string& kind, const InstructionSet& isa, std::size_t bytes) {
  const bool is_scalar = isa.is_scalar();
  const std::string move = is_scalar ? "movsd" : "vmovapd", reg = isa.register_name;
  const int step = is_scalar ? int(sizeof(double)) : isa.pack_bytes;
  const std::size_t quarter = bytes / 4;
  std::string text = "1:\n";
  for (int r = 0; r < 4; ++r) {
    const int at = r * step;
    const std::size_t second = quarter + std::size_t(at), third = second + quarter;
    text += fmt::format("{} {}(%rdi), %{}{}\n", move, at, reg, r);
    if (kind == "triad") {
      if (is_scalar)
        text +=
            fmt::format("mulsd {1}(%rdi), %xmm{0}\naddsd {2}(%rdi), %xmm{0}\n", r, second, third);
      else
        text += fmt::format("{0} {2}(%rdi), %{4}{5}\nvfmadd231pd {3}(%rdi), %{4}{5}, %{4}{1}\n",
                            move, r, second, third, reg, r + 4);
    }
    if (kind != "load") text += fmt::format("{} %{}{}, {}(%rsi)\n", move, reg, r, at);
  }
  text += fmt::format("add ${0}, %rdi\nadd ${0}, %rsi\ndec %rdx\njnz 1b\n", 4 * step);
  return is_scalar ? text : text + "vzeroupper\n";
}

} // namespace dss
