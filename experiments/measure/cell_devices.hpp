#pragma once
/// Cells that compute on devices or as hybrids: reads them, and says if they can run on this
/// machine.
#include "experiments/measure/cell.hpp"
#include "solver/json/node.hpp"

#include <string>

namespace dss {

/// Requires a known variant. If `device` is given, also requires a variant that computes on
/// devices.
/// @throws InputError with the place
void require_device_variant(const std::string& variant, const std::string& device,
                            const Node& place);

/// Members of a hybrid as `dssbench run --hybrid` takes them, or "auto". Replaces ":cores" by the
/// number of cores and ":rest" by one less, but at least 1.
/// @throws InputError with the place of the mistake
std::string members_text(const Node& place, int cores);

/// Number of threads of those members that compute on this CPU; at least 1.
int threads_of_members(const std::string& members);

/// Reason why a cell has no device to run on: no such device, or the device lacks the precision.
/// Empty if it can run.
std::string why_no_device(const Cell& cell);
/// Any other reason why a member of a hybrid cannot run here; empty if it can.
std::string why_no_members(const std::string& members);

} // namespace dss
