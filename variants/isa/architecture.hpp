#pragma once
/// The header of the processor that is compiled for: whether scalar code may use fused
/// multiply-add, the register that says how denormals are treated, and how a thread spins.
#if defined(__x86_64__)
#include "variants/isa/x86/architecture.hpp"
#elif defined(__aarch64__)
#include "variants/isa/aarch64/architecture.hpp"
#else
#error "variants/isa has no folder for this processor"
#endif
