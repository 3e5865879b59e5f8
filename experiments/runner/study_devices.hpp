#pragma once
/// Cells on devices and of hybrids: what a study says of them, and whether it is here.
#include "experiments/runner/study.hpp"
#include "experiments/runner/study_reader.hpp"

#include <string>

namespace dss {

/// @throws InputError with the place: unknown variant, or a device for one that runs on the CPU
void require_device_variant(const std::string& variant, const std::string& device, const JsonPlace& place);

/// Members as `dssbench run --hybrid` takes them, or "auto"; ":cores" is the number of cores, ":rest" one less, one at least.
/// @throws InputError with the place of what is wrong
std::string members_text(const JsonPlace& place, int cores);

/// Threads of a hybrid's members that compute on this CPU, one at least.
int threads_of_members(const std::string& members);

/// Why a cell cannot run for want of a device: there is none, or it lacks the precision; else empty.
std::string why_no_device(const Cell& cell);
/// Why a member of a hybrid cannot run here for other reasons, or empty.
std::string why_no_members(const std::string& members);

} // namespace dss
