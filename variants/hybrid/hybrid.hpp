#pragma once
#include "variants/api/api.hpp"

namespace dss {

/// The executor of the variant `hybrid`, with the members that Setup names.
/// @throws InputError that says what is wrong with the members
std::unique_ptr<Executor> create_hybrid(const Setup& setup);

} // namespace dss
