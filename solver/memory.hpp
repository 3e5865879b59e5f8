#pragma once
/// Memory of this machine.
namespace dss {

/// Memory that this process may still take [bytes]: what the kernel calls available, within the
/// limits of its cgroup and of `ulimit -v`. Infinite if nothing tells.
double available_memory();

} // namespace dss
