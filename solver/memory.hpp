#pragma once
/// Memory of this machine.
#include <string>

namespace dss {

/// Memory that this process may still take [bytes]: what the kernel calls available, within the
/// limits of its cgroup and of `ulimit -v`. Infinite if nothing tells.
/// @param root  of the file system, for tests
double available_memory(const std::string& root = {});

/// Requires that so many bytes are available.
/// @param what  what needs them, in the plural; `advice`: what to do if they are not
/// @throws InputError if they are not
void require_memory(double bytes, const std::string& what, const std::string& advice);

} // namespace dss
