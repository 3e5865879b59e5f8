#pragma once
/// Counts the instructions that a kernel executes. Counting shows what declared costs do not: moves
/// between registers and the stack.
#include "kernels/compiled_kernel.hpp"
#include "variants/isa/instruction_mix.hpp"

namespace dss {

/// Instructions per pack of a row kernel (a pack: as many elements as a register has lanes). A
/// child process runs the kernel step by step (ptrace); the disassembly of its module (objdump)
/// tells what each executed address is.
/// @throws InputError if the system forbids tracing, or binutils are missing
InstructionMix executed_mix(const CompiledKernel& kernel);

} // namespace dss
