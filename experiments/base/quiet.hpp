#pragma once
/// Whether other programs use the processors of this machine now.
#include <string>

namespace dss {

/// What other programs do on the processors, "2 other threads are running"; empty if the machine is
/// quiet, or does not tell. Looks three times within 20 ms, and counts what ran every time
/// (/proc/loadavg).
std::string disturbance();

} // namespace dss
