#pragma once

namespace dss {

/// Tries a thread with the stack that OMP_STACKSIZE or GOMP_STACKSIZE asks for. OpenMP's own
/// runtime would end the program in mid-run.
/// @throws InputError if no thread can have it
void require_thread_stacks();

} // namespace dss
