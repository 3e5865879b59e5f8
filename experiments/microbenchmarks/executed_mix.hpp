#pragma once
/// Which instructions a kernel executes: counted, not declared, so that moves of registers to the stack are seen too.
#include "experiments/microbenchmarks/generated_code.hpp"
#include "kernels/compiled_kernel.hpp"

namespace dss {

/// Instructions of one pack of a row kernel (elements as one register has them), by running it instruction by instruction in a process of its own
/// (ptrace) and looking up what was executed in the disassembly of its module (objdump).
/// @throws InputError where the system does not allow that, or binutils are missing
InstructionMix executed_mix(const CompiledKernel& kernel);

} // namespace dss
